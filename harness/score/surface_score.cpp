#include "harness/score/surface_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "sensors/depth_field.h"
#include "sim/ray_caster.h"
#include "sim/surface_distance.h"

namespace waretwin {

namespace {

constexpr int kStep = 8;               // pixels
constexpr float kCell = 0.02f;         // metres
constexpr float kFacing = 0.1736482f;  // cos 80 deg
constexpr float kNear = 0.03f;         // metres: found
constexpr float kGone = 0.005f;        // metres: farther from all surfaces, a seen point's own is no longer there
constexpr float kFarthest = 1.0f;

std::uint64_t cell_of(const Eigen::Vector3f& p) {
  const auto part = [](float x) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / kCell)) + (1 << 20)) & 0x1fffff;
  };
  return part(p.x()) << 42 | part(p.y()) << 21 | part(p.z());
}

// Cosine of the angle between a ray and the normal of what it hit.
float facing(const RayCaster& caster, const Hit& hit, const Eigen::Vector3f& direction) {
  const Mesh& mesh = caster.scene().meshes[static_cast<std::size_t>(caster.scene().instances[static_cast<std::size_t>(hit.instance)].mesh)];
  const Eigen::Affine3f& X_WM = caster.transform(hit.instance);
  const std::uint32_t* const corner = &mesh.triangles[std::size_t{3} * static_cast<std::size_t>(hit.primitive)];
  const Eigen::Vector3f a = X_WM * mesh.positions[corner[0]], b = X_WM * mesh.positions[corner[1]], c = X_WM * mesh.positions[corner[2]];
  return std::abs((b - a).cross(c - a).normalized().dot(direction.normalized()));
}

std::vector<float> distances(const SurfaceDistance& surface, const std::vector<Eigen::Vector3f>& points, float farthest) {
  std::vector<float> result(points.size());
  parallel_for(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = surface.to(points[i], farthest);
  });
  return result;
}

double share_of(const std::vector<float>& values, std::size_t count) {
  return values.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(values.size());
}

}  // namespace

SurfaceMeter::SurfaceMeter(std::shared_ptr<const RayCaster> ray_caster) : ray_caster_(std::move(ray_caster)) {}

void SurfaceMeter::add_frame(const CameraConfig& camera, const Pose& X_WC) {
  const Intrinsics intrinsics = camera.intrinsics();
  const Eigen::Affine3f X(X_WC.cast<float>().matrix());
  std::vector<Ray> rays;
  for (int v = kStep / 2; v < intrinsics.height; v += kStep) {
    for (int u = kStep / 2; u < intrinsics.width; u += kStep) {
      const Eigen::Vector3d ray_C = intrinsics.ray(u, v);
      if (!in_depth_field(camera.field, ray_C)) continue;
      Ray ray;
      ray.origin = X.translation();
      ray.direction = X.linear() * ray_C.cast<float>();
      ray.near = 0.0f;
      ray.far = static_cast<float>(camera.depth_max_m);
      rays.push_back(ray);
    }
  }
  std::vector<Hit> hits(rays.size());
  ray_caster_->cast(rays, hits, Coherence::kCoherent);
  const auto least = static_cast<float>(camera.depth_min_m);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].valid() || hits[i].distance < least || facing(*ray_caster_, hits[i], rays[i].direction) < kFacing) continue;
    const Eigen::Vector3f p = rays[i].at(hits[i].distance);
    if (cells_.try_emplace(cell_of(p), static_cast<std::uint32_t>(points_W_.size())).second) points_W_.push_back(p);
  }
}

SurfaceScore SurfaceMeter::result(const SurfaceMesh& mesh) const {
  SurfaceScore score;
  const SurfaceDistance hall(world_triangles(*ray_caster_));
  std::vector<float> errors = distances(hall, mesh.vertices, kFarthest);
  score.vertices = static_cast<int>(errors.size());
  if (!errors.empty()) {
    score.distances_m = errors;
    std::sort(errors.begin(), errors.end());
    const auto quantile = [&](double q) {
      return static_cast<double>(errors[static_cast<std::size_t>(std::lround(q * static_cast<double>(errors.size() - 1)))]);
    };
    score.mean_m = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
    score.median_m = quantile(0.5);
    score.p95_m = quantile(0.95);
    score.share_over_30mm =
        share_of(errors, static_cast<std::size_t>(errors.end() - std::upper_bound(errors.begin(), errors.end(), 0.03f)));
  }
  std::vector<Eigen::Vector3f> there;
  const std::vector<float> moved = distances(hall, points_W_, 2.0f * kGone);
  for (std::size_t i = 0; i < points_W_.size(); ++i) {
    if (moved[i] <= kGone) there.push_back(points_W_[i]);
  }
  score.seen_points = static_cast<int>(there.size());
  const SurfaceDistance mapped(TriangleSoup{mesh.vertices, mesh.triangles});
  const std::vector<float> gaps = distances(mapped, there, 2.0f * kNear);
  score.found = share_of(gaps, static_cast<std::size_t>(std::count_if(gaps.begin(), gaps.end(), [](float gap) { return gap <= kNear; })));
  return score;
}

}  // namespace waretwin
