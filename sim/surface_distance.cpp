#include "sim/surface_distance.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "sim/ray_caster.h"

namespace waretwin {

TriangleSoup world_triangles(const RayCaster& ray_caster) {
  const Scene& scene = ray_caster.scene();
  TriangleSoup soup;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (ray_caster.bounds(static_cast<int>(i)).isEmpty()) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)];
    const Eigen::Affine3f& X_WM = ray_caster.transform(static_cast<int>(i));
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const Eigen::Vector3f& p : mesh.positions) soup.vertices.push_back(X_WM * p);
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      soup.triangles.push_back({first + mesh.triangles[t], first + mesh.triangles[t + 1], first + mesh.triangles[t + 2]});
    }
  }
  return soup;
}

float distance_to_triangle(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0f && d2 <= 0.0f) return ap.norm();
  const Eigen::Vector3f bp = p - b;
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0f && d4 <= d3) return bp.norm();
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f && d1 > d3) return (ap - ab * (d1 / (d1 - d3))).norm();
  const Eigen::Vector3f cp = p - c;
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0f && d5 <= d6) return cp.norm();
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f && d2 > d6) return (ap - ac * (d2 / (d2 - d6))).norm();
  const float va = d3 * d6 - d5 * d4;
  const float along = (d4 - d3) + (d5 - d6);
  if (va <= 0.0f && d4 >= d3 && d5 >= d6 && along > 0.0f) return (bp - (c - b) * ((d4 - d3) / along)).norm();
  const float sum = va + vb + vc;
  // Three corners in a line, or one point: the edges have answered, but for rounding.
  if (!(sum > 0.0f)) return std::min({ap.norm(), bp.norm(), cp.norm()});
  return (ap - ab * (vb / sum) - ac * (vc / sum)).norm();
}

struct SurfaceDistance::State {
  TriangleSoup soup;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

// Shrinks the query's radius to the triangle's distance.
bool take_nearer(RTCPointQueryFunctionArguments* args) {
  const auto& soup = *static_cast<const TriangleSoup*>(args->userPtr);
  const auto& t = soup.triangles[args->primID];
  const float distance =
      distance_to_triangle({args->query->x, args->query->y, args->query->z}, soup.vertices[t[0]], soup.vertices[t[1]], soup.vertices[t[2]]);
  if (!(distance < args->query->radius)) return false;
  args->query->radius = distance;
  return true;
}

}  // namespace

SurfaceDistance::SurfaceDistance(TriangleSoup soup) : state_(std::make_unique<State>()) {
  state_->soup = std::move(soup);
  state_->device = rtcNewDevice(nullptr);
  if (state_->device == nullptr) throw InternalError("Embree cannot be opened");
  state_->scene = rtcNewScene(state_->device);
  RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const TriangleSoup& all = state_->soup;
  // Embree reads whole 16 bytes at the last vertex of a shared buffer: it gets its own.
  auto* const vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), all.vertices.size()));
  auto* const corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), all.triangles.size()));
  if ((vertices == nullptr && !all.vertices.empty()) || (corners == nullptr && !all.triangles.empty())) throw std::bad_alloc();
  for (std::size_t i = 0; i < all.vertices.size(); ++i) std::copy_n(all.vertices[i].data(), 3, vertices + 3 * i);
  for (std::size_t i = 0; i < all.triangles.size(); ++i) std::copy_n(all.triangles[i].data(), 3, corners + 3 * i);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
  tbb::task_arena arena(1);
  arena.execute([this] { rtcCommitScene(state_->scene); });
}

SurfaceDistance::~SurfaceDistance() = default;

float SurfaceDistance::to(const Eigen::Vector3f& p, float farthest) const {
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{};
  query.x = p.x();
  query.y = p.y();
  query.z = p.z();
  query.radius = farthest;
  rtcPointQuery(state_->scene, &query, &context, take_nearer, &state_->soup);
  return query.radius;
}

}  // namespace waretwin
