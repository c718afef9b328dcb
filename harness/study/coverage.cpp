#include "harness/study/coverage.h"

#include <cmath>
#include <utility>

#include "sim/robot.h"

namespace waretwin {

namespace {

// The floor is what lies at most this far from z = 0; what stands higher than the vehicle's belly over it is no floor.
constexpr float kFloorTolerance = 0.03f, kAbove = 0.3f;

std::vector<SurfaceSample> floor_of(const RayCaster& hall, double spacing) {
  const Eigen::AlignedBox3f bounds = hall.bounds();
  const auto step = static_cast<float>(spacing);
  std::vector<SurfaceSample> samples;
  for (float y = bounds.min().y() + 0.5f * step; y < bounds.max().y(); y += step) {
    for (float x = bounds.min().x() + 0.5f * step; x < bounds.max().x(); x += step) {
      Ray down;
      down.origin = {x, y, kAbove};
      down.direction = -Eigen::Vector3f::UnitZ();
      down.far = kAbove + kFloorTolerance;
      const Hit hit = hall.cast(down);
      if (!hit.valid() || kAbove - hit.distance > kFloorTolerance) continue;
      samples.push_back({{x, y, kAbove - hit.distance}, Eigen::Vector3f::UnitZ()});
    }
  }
  return samples;
}

// What is still to be seen, smaller with every look.
class Unseen {
 public:
  explicit Unseen(const std::vector<SurfaceSample>& samples) {
    for (const SurfaceSample& sample : samples) {
      if (sample.viewable) left_.push_back(sample);
    }
    viewable_ = left_.size();
  }

  void look(const RayCaster& hall, const CameraConfig& camera, const Pose& X_WC, const VehicleInView& own_body) {
    for (const std::size_t i : seen_in_frame(&hall, left_, camera, X_WC, own_body)) left_[i].seen = true;
    std::erase_if(left_, [](const SurfaceSample& sample) { return sample.seen; });
  }

  double share() const { return viewable_ > 0 ? 1.0 - static_cast<double>(left_.size()) / static_cast<double>(viewable_) : 0.0; }

 private:
  std::vector<SurfaceSample> left_;
  std::size_t viewable_ = 0;
};

}  // namespace

CoverageHall::CoverageHall(std::shared_ptr<const RayCaster> hall, const RobotConfig& robot, const CoverageConfig& config)
    : hall_(std::move(hall)), config_(config), floor_(floor_of(*hall_, config.floor_spacing_m)) {
  const std::vector<Eigen::Vector2f> places = free_places(*hall_, robot, config.place_spacing_m);
  std::vector<Lookout> lookouts;
  for (const double height : config.heights_m)
    lookouts.push_back({static_cast<float>(height), static_cast<float>(config.least_m), static_cast<float>(config.reach_m)});
  find_viewable(*hall_, floor_, places, lookouts);
  const Scene& scene = hall_->scene();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    objects_.push_back(sample_surface(*hall_, static_cast<int>(i), scene.objects[i].id, config.points_per_object));
    find_viewable(*hall_, objects_.back(), places, lookouts);
  }
}

Coverage CoverageHall::along_route(const Scenario& scenario, const RayCaster* own_body, FloorLooks* looks) const {
  const RobotMotion plan(scenario.robot);
  Coverage coverage;
  coverage.route_s = to_seconds(plan.duration());
  std::vector<Unseen> objects(objects_.begin(), objects_.end());
  Unseen floor(floor_);
  if (looks != nullptr) looks->assign(floor_.size(), 0);
  const auto count = static_cast<int>(std::floor(coverage.route_s * config_.rate_hz)) + 1;
  Pose last = Pose::Identity();
  for (int i = 0; i < count; ++i) {
    const Pose X_WB = plan.X_WB(from_seconds(i / config_.rate_hz));
    if (i > 0 && X_WB.isApprox(last, 1e-12)) continue;
    last = X_WB;
    const VehicleInView body{own_body, X_WB};
    for (const auto& [name, camera] : scenario.sensors.cameras) {
      const Pose X_WC = X_WB * camera.mount.X_BC();
      for (Unseen& object : objects) object.look(*hall_, camera, X_WC, body);
      floor.look(*hall_, camera, X_WC, body);
      if (looks == nullptr) continue;
      for (const std::size_t k : seen_in_frame(hall_.get(), floor_, camera, X_WC, body)) ++(*looks)[k];
    }
  }
  for (const Unseen& object : objects) coverage.objects.push_back(object.share());
  coverage.floor = floor.share();
  return coverage;
}

double CoverageHall::best_moment(const Scenario& scenario) const {
  const RobotMotion plan(scenario.robot);
  const double route_s = to_seconds(plan.duration());
  double best = 0.0;
  std::size_t most = 0;
  for (double t = 0.0; t <= route_s; t += 1.0 / config_.rate_hz) {
    const Pose X_WB = plan.X_WB(from_seconds(t));
    std::size_t seen = 0;
    for (const auto& [name, camera] : scenario.sensors.cameras) {
      for (const auto& object : objects_) seen += seen_in_frame(hall_.get(), object, camera, X_WB * camera.mount.X_BC()).size();
    }
    if (seen <= most) continue;
    most = seen;
    best = route_s > 0.0 ? t / route_s : 0.0;
  }
  return best;
}

std::shared_ptr<const RayCaster> own_body_of(const Scene& scene) {
  if (scene.vehicle.empty()) return nullptr;
  auto alone = std::make_shared<Scene>();
  alone->name = "vehicle";
  alone->textures = scene.textures;
  alone->materials = scene.materials;
  // Its own meshes alone: each gets a tree.
  for (const int index : scene.vehicle) {
    Instance instance = scene.instances[static_cast<std::size_t>(index)];
    alone->meshes.push_back(scene.meshes[static_cast<std::size_t>(instance.mesh)]);
    instance.mesh = static_cast<int>(alone->meshes.size()) - 1;
    alone->instances.push_back(instance);
  }
  return std::make_shared<const RayCaster>(alone);
}

}  // namespace waretwin
