#include "sim/view_points.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "sensors/depth_field.h"

namespace waretwin {

namespace {

// Cosine of the angle between the line of sight and the normal beyond which a depth camera reads nothing (85 deg).
constexpr float kFacing = 0.0871557f;
// Rays end this much before the point they aim at, so that its own surface doesn't hide it.
constexpr float kShort = 0.002f;
// Steps and sills that a robot can stand on or over.
constexpr float kFloorTolerance = 0.03f;

}  // namespace

// At the middles of equal steps of the area, summed up triangle by triangle.
std::vector<SurfaceSample> sample_surface(const RayCaster& caster, int object, int id, int count) {
  const Scene& scene = caster.scene();
  struct Triangle {
    Eigen::Vector3f a, e1, e2;
    double area_before;
  };
  std::vector<Triangle> triangles;
  double area = 0.0;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (scene.instances[i].object != object) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)];
    const Eigen::Affine3f& X_WM = caster.transform(static_cast<int>(i));
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const Eigen::Vector3f a = X_WM * mesh.positions[mesh.triangles[t]];
      const Eigen::Vector3f e1 = X_WM * mesh.positions[mesh.triangles[t + 1]] - a;
      const Eigen::Vector3f e2 = X_WM * mesh.positions[mesh.triangles[t + 2]] - a;
      const double size = 0.5 * static_cast<double>(e1.cross(e2).norm());
      if (!(size > 0.0)) continue;
      triangles.push_back({a, e1, e2, area});
      area += size;
    }
  }
  std::vector<SurfaceSample> samples;
  if (triangles.empty()) return samples;
  const RandomStream random(0, "surface_coverage", "points", id);
  for (int k = 0; k < count; ++k) {
    const double at = (k + 0.5) / count * area;
    const auto after =
        std::upper_bound(triangles.begin(), triangles.end(), at, [](double x, const Triangle& t) { return x < t.area_before; });
    const Triangle& t = *(after - 1);
    auto [u, v] = random.uniform_pair(static_cast<std::uint64_t>(k));
    if (u + v > 1.0f) {
      u = 1.0f - u;
      v = 1.0f - v;
    }
    SurfaceSample sample;
    sample.p_W = t.a + u * t.e1 + v * t.e2;
    sample.normal = t.e1.cross(t.e2).normalized();
    samples.push_back(sample);
  }
  return samples;
}

std::vector<Eigen::Vector2f> free_places(const RayCaster& caster, const RobotConfig& robot, double spacing) {
  const Eigen::AlignedBox3f bounds = caster.bounds();
  const auto radius = static_cast<float>(0.5 * std::hypot(robot.length_m, robot.width_m));
  const auto height = static_cast<float>(robot.height_m);
  const auto step = static_cast<float>(spacing);
  std::vector<Eigen::Vector2f> places;
  constexpr int kDirections = 24;
  for (float y = bounds.min().y() + radius; y <= bounds.max().y() - radius; y += step) {
    for (float x = bounds.min().x() + radius; x <= bounds.max().x() - radius; x += step) {
      // Spokes at three heights, and rays down from the robot's top onto rings, find what stands in the disc.
      std::vector<Ray> rays;
      for (int k = 0; k < kDirections; ++k) {
        const double angle = 2.0 * EIGEN_PI * k / kDirections;
        const Eigen::Vector3f direction(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0f);
        for (const float z : {kFloorTolerance, 0.5f * height, height}) {
          Ray ray;
          ray.origin = {x, y, std::max(z, kFloorTolerance)};
          ray.direction = direction;
          ray.far = radius;
          rays.push_back(ray);
        }
        for (const float ring : {0.33f, 0.66f, 1.0f}) {
          Ray ray;
          ray.origin = Eigen::Vector3f(x, y, height) + ring * radius * direction;
          ray.direction = -Eigen::Vector3f::UnitZ();
          ray.far = height - kFloorTolerance;
          rays.push_back(ray);
        }
      }
      std::vector<std::uint8_t> blocked(rays.size());
      caster.occluded(rays, blocked);
      if (std::find(blocked.begin(), blocked.end(), std::uint8_t{1}) == blocked.end()) places.emplace_back(x, y);
    }
  }
  return places;
}

Ray sight(const Eigen::Vector3f& eye, const SurfaceSample& sample) {
  Ray ray;
  ray.origin = eye;
  ray.direction = sample.p_W - eye;
  const float distance = ray.direction.norm();
  ray.far = std::abs(sample.normal.dot(ray.direction)) > kFacing * distance && distance > kShort ? 1.0f - kShort / distance : -1.0f;
  return ray;
}

void find_viewable(const RayCaster& caster, std::span<SurfaceSample> samples, const std::vector<Eigen::Vector2f>& places,
                   const std::vector<Lookout>& lookouts) {
  parallel_for(samples.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<std::uint8_t> blocked;
    for (std::size_t i = begin; i < end; ++i) {
      SurfaceSample& sample = samples[i];
      for (const Lookout& lookout : lookouts) {
        rays.clear();
        for (const Eigen::Vector2f& place : places) {
          const Eigen::Vector3f eye(place.x(), place.y(), lookout.height);
          const float squared = (sample.p_W - eye).squaredNorm();
          if (squared > lookout.reach * lookout.reach || squared < lookout.least * lookout.least) continue;
          const Ray ray = sight(eye, sample);
          if (ray.far > 0.0f) rays.push_back(ray);
        }
        // In packets, so that the first clear view ends the search.
        for (std::size_t k = 0; k < rays.size() && !sample.viewable; k += 8) {
          const std::size_t count = std::min<std::size_t>(8, rays.size() - k);
          blocked.assign(count, 0);
          caster.occluded(std::span(rays).subspan(k, count), blocked);
          sample.viewable = std::find(blocked.begin(), blocked.end(), std::uint8_t{0}) != blocked.end();
        }
        if (sample.viewable) break;
      }
    }
  });
}

std::vector<std::size_t> seen_in_frame(const RayCaster* hall, std::span<const SurfaceSample> samples, const CameraConfig& camera,
                                       const Pose& X_WC, const VehicleInView& own_body) {
  const Intrinsics intrinsics = camera.intrinsics();
  const Eigen::Affine3d X_CW(X_WC.inverse().matrix());
  const Eigen::Vector3f eye = X_WC.translation().cast<float>();
  std::vector<Ray> rays;
  std::vector<std::size_t> aims;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SurfaceSample& sample = samples[i];
    if (sample.seen || !sample.viewable) continue;
    const Eigen::Vector3d p_C = X_CW * sample.p_W.cast<double>();
    if (p_C.z() < camera.depth_min_m || p_C.z() > camera.depth_max_m) continue;
    const Eigen::Vector2d pixel = intrinsics.project(p_C);
    if (!intrinsics.contains(pixel.x(), pixel.y()) || !in_depth_field(camera.field, p_C)) continue;
    const Ray ray = sight(eye, sample);
    if (!(ray.far > 0.0f)) continue;
    rays.push_back(ray);
    aims.push_back(i);
  }
  std::vector<std::uint8_t> blocked(rays.size());
  if (hall != nullptr) hall->occluded(rays, blocked, Coherence::kCoherent);
  if (own_body.shape_B != nullptr) {
    const Eigen::Isometry3f X_BW = own_body.X_WB.inverse().cast<float>();
    std::vector<std::uint8_t> by_itself(rays.size());
    for (Ray& ray : rays) {
      ray.origin = X_BW * ray.origin;
      ray.direction = X_BW.linear() * ray.direction;
    }
    own_body.shape_B->occluded(rays, by_itself, Coherence::kCoherent);
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] |= by_itself[i];
  }
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < aims.size(); ++i) {
    if (!blocked[i]) seen.push_back(aims[i]);
  }
  return seen;
}

}  // namespace waretwin
