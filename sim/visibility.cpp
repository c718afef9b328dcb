#include "sim/visibility.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/depth_field.h"
#include "sim/ray_caster.h"

namespace waretwin {

namespace {

// Cosine of the angle between the line of sight and the normal beyond which a depth camera reads nothing (85 deg).
constexpr float kFacing = 0.0871557f;
// Rays end this much before the point they aim at, so that its own surface doesn't hide it.
constexpr float kShort = 0.002f;
// Steps and sills that a robot can stand on or over.
constexpr float kFloorTolerance = 0.03f;

struct SurfaceSample {
  Eigen::Vector3f p_W;
  Eigen::Vector3f normal;  // outwards where the mesh winds counter-clockwise; either side counts
  bool viewable = false;
  bool seen = false;
};

struct ObjectSurface {
  int id = 0;
  std::vector<SurfaceSample> samples;
};

// Points spread over the triangles of all instances of an object in proportion to area, at the middles of equal steps of the area summed up
// triangle by triangle.
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

// From the eye almost to the sample, or an empty ray (far < near) where it is seen too flat.
Ray sight(const Eigen::Vector3f& eye, const SurfaceSample& sample) {
  Ray ray;
  ray.origin = eye;
  ray.direction = sample.p_W - eye;
  const float distance = ray.direction.norm();
  ray.far = std::abs(sample.normal.dot(ray.direction)) > kFacing * distance && distance > kShort ? 1.0f - kShort / distance : -1.0f;
  return ray;
}

}  // namespace

struct SurfaceCoverage::State {
  std::shared_ptr<const RayCaster> caster;
  std::map<std::string, CameraConfig> cameras;
  std::vector<ObjectSurface> objects;

  std::vector<Eigen::Vector2f> free_places(const RobotConfig& robot, double spacing) const;
  void find_viewable(ObjectSurface& object, const std::vector<Eigen::Vector2f>& places) const;
  // Indices of the samples that a frame sees and none before it saw.
  std::vector<std::size_t> newly_seen(const ObjectSurface& object, const CameraConfig& camera, const Pose& X_WC) const;
  const CameraConfig& camera(const std::string& sensor) const;
  const ObjectSurface& object(int id) const;
};

std::vector<Eigen::Vector2f> SurfaceCoverage::State::free_places(const RobotConfig& robot, double spacing) const {
  const Eigen::AlignedBox3f bounds = caster->bounds();
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
      caster->occluded(rays, blocked);
      if (std::find(blocked.begin(), blocked.end(), std::uint8_t{1}) == blocked.end()) places.emplace_back(x, y);
    }
  }
  return places;
}

void SurfaceCoverage::State::find_viewable(ObjectSurface& object, const std::vector<Eigen::Vector2f>& places) const {
  parallel_for(object.samples.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<std::uint8_t> blocked;
    for (std::size_t i = begin; i < end; ++i) {
      SurfaceSample& sample = object.samples[i];
      for (const auto& [name, camera] : cameras) {
        const auto height = static_cast<float>(camera.mount.z_m);
        const auto reach = static_cast<float>(camera.depth_max_m), least = static_cast<float>(camera.depth_min_m);
        rays.clear();
        for (const Eigen::Vector2f& place : places) {
          const Eigen::Vector3f eye(place.x(), place.y(), height);
          const float squared = (sample.p_W - eye).squaredNorm();
          if (squared > reach * reach || squared < least * least) continue;
          const Ray ray = sight(eye, sample);
          if (ray.far > 0.0f) rays.push_back(ray);
        }
        // In packets, so that the first clear view ends the search.
        for (std::size_t k = 0; k < rays.size() && !sample.viewable; k += 8) {
          const std::size_t count = std::min<std::size_t>(8, rays.size() - k);
          blocked.assign(count, 0);
          caster->occluded(std::span(rays).subspan(k, count), blocked);
          sample.viewable = std::find(blocked.begin(), blocked.end(), std::uint8_t{0}) != blocked.end();
        }
        if (sample.viewable) break;
      }
    }
  });
}

std::vector<std::size_t> SurfaceCoverage::State::newly_seen(const ObjectSurface& object, const CameraConfig& camera,
                                                            const Pose& X_WC) const {
  const Intrinsics intrinsics = camera.intrinsics();
  const Eigen::Affine3d X_CW(X_WC.inverse().matrix());
  const Eigen::Vector3f eye = X_WC.translation().cast<float>();
  std::vector<Ray> rays;
  std::vector<std::size_t> aims;
  for (std::size_t i = 0; i < object.samples.size(); ++i) {
    const SurfaceSample& sample = object.samples[i];
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
  caster->occluded(rays, blocked, Coherence::kCoherent);
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < aims.size(); ++i) {
    if (!blocked[i]) seen.push_back(aims[i]);
  }
  return seen;
}

const CameraConfig& SurfaceCoverage::State::camera(const std::string& sensor) const {
  const auto found = cameras.find(sensor);
  if (found == cameras.end()) throw Error("surface coverage: no camera '" + sensor + "'");
  return found->second;
}

const ObjectSurface& SurfaceCoverage::State::object(int id) const {
  const auto found = std::find_if(objects.begin(), objects.end(), [id](const ObjectSurface& o) { return o.id == id; });
  if (found == objects.end()) throw Error("object " + std::to_string(id) + " is not in the scene");
  return *found;
}

SurfaceCoverage::SurfaceCoverage(std::shared_ptr<const RayCaster> ray_caster, std::map<std::string, CameraConfig> cameras,
                                 const RobotConfig& robot, int points_per_object, double place_spacing_m)
    : state_(std::make_unique<State>()) {
  if (cameras.empty()) throw Error("surface coverage: no cameras; expected at least one");
  WARETWIN_CHECK(points_per_object > 0 && place_spacing_m > 0.0, "points and places have a number and a spacing");
  state_->caster = std::move(ray_caster);
  state_->cameras = std::move(cameras);
  const Scene& scene = state_->caster->scene();
  const std::vector<Eigen::Vector2f> places = state_->free_places(robot, place_spacing_m);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    ObjectSurface object;
    object.id = scene.objects[i].id;
    object.samples = sample_surface(*state_->caster, static_cast<int>(i), object.id, points_per_object);
    state_->find_viewable(object, places);
    state_->objects.push_back(std::move(object));
  }
}

SurfaceCoverage::~SurfaceCoverage() = default;

void SurfaceCoverage::add_frame(const std::string& sensor, const Pose& X_WC) {
  const CameraConfig& camera = state_->camera(sensor);
  parallel_for(state_->objects.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ObjectSurface& object = state_->objects[i];
      for (const std::size_t k : state_->newly_seen(object, camera, X_WC)) object.samples[k].seen = true;
    }
  });
}

void SurfaceCoverage::forget_frames() {
  for (ObjectSurface& object : state_->objects) {
    for (SurfaceSample& sample : object.samples) sample.seen = false;
  }
}

double SurfaceCoverage::fraction(int object_id) const {
  int viewable = 0, seen = 0;
  for (const SurfaceSample& sample : state_->object(object_id).samples) {
    viewable += sample.viewable ? 1 : 0;
    seen += sample.seen ? 1 : 0;
  }
  return viewable > 0 ? static_cast<double>(seen) / viewable : 0.0;
}

double SurfaceCoverage::would_add(const std::string& sensor, const Pose& X_WC, int object_id) const {
  const ObjectSurface& object = state_->object(object_id);
  const auto viewable = std::count_if(object.samples.begin(), object.samples.end(), [](const SurfaceSample& s) { return s.viewable; });
  const std::size_t fresh = state_->newly_seen(object, state_->camera(sensor), X_WC).size();
  return viewable > 0 ? static_cast<double>(fresh) / static_cast<double>(viewable) : 0.0;
}

double SurfaceCoverage::viewable(int object_id) const {
  const auto& samples = state_->object(object_id).samples;
  if (samples.empty()) return 0.0;
  const auto count = std::count_if(samples.begin(), samples.end(), [](const SurfaceSample& s) { return s.viewable; });
  return static_cast<double>(count) / static_cast<double>(samples.size());
}

}  // namespace waretwin
