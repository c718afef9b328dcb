#include "sim/visibility.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/ray_caster.h"
#include "sim/view_points.h"

namespace waretwin {

namespace {

struct ObjectSurface {
  int id = 0;
  std::vector<SurfaceSample> samples;
};

}  // namespace

struct SurfaceCoverage::State {
  std::shared_ptr<const RayCaster> caster;
  std::map<std::string, CameraConfig> cameras;
  std::vector<ObjectSurface> objects;

  const CameraConfig& camera(const std::string& sensor) const;
  const ObjectSurface& object(int id) const;
};

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
  const std::vector<Eigen::Vector2f> places = free_places(*state_->caster, robot, place_spacing_m);
  std::vector<Lookout> lookouts;
  for (const auto& [name, camera] : state_->cameras) {
    lookouts.push_back(
        {static_cast<float>(camera.mount.z_m), static_cast<float>(camera.depth_min_m), static_cast<float>(camera.depth_max_m)});
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    ObjectSurface object;
    object.id = scene.objects[i].id;
    object.samples = sample_surface(*state_->caster, static_cast<int>(i), object.id, points_per_object);
    find_viewable(*state_->caster, object.samples, places, lookouts);
    state_->objects.push_back(std::move(object));
  }
}

SurfaceCoverage::~SurfaceCoverage() = default;

void SurfaceCoverage::add_frame(const std::string& sensor, const Pose& X_WC) {
  const CameraConfig& camera = state_->camera(sensor);
  parallel_for(state_->objects.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ObjectSurface& object = state_->objects[i];
      for (const std::size_t k : seen_in_frame(state_->caster.get(), object.samples, camera, X_WC)) object.samples[k].seen = true;
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
  const std::size_t fresh = seen_in_frame(state_->caster.get(), object.samples, state_->camera(sensor), X_WC).size();
  return viewable > 0 ? static_cast<double>(fresh) / static_cast<double>(viewable) : 0.0;
}

double SurfaceCoverage::viewable(int object_id) const {
  const auto& samples = state_->object(object_id).samples;
  if (samples.empty()) return 0.0;
  const auto count = std::count_if(samples.begin(), samples.end(), [](const SurfaceSample& s) { return s.viewable; });
  return static_cast<double>(count) / static_cast<double>(samples.size());
}

}  // namespace waretwin
