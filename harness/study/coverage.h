// What a vehicle's depth cameras see of a hall along its route, by rays alone: nothing is rendered, nothing mapped.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/study/study_config.h"
#include "scenes/scenario.h"
#include "sim/ray_caster.h"
#include "sim/view_points.h"

namespace waretwin {

struct Coverage {
  std::vector<double> objects;  // share of each one's viewable surface, in the order of Scene::objects; 0 where nothing is viewable
  double floor = 0.0;           // share of the viewable floor
  double route_s = 0.0;
};

// A point of the floor and how often it was looked at; in the order of CoverageHall::floor().
using FloorLooks = std::vector<int>;

class CoverageHall {
 public:
  // The hall as it stands in the caster; what moves in it does not count. Viewable is what a camera at one of the configured heights sees
  // from some place where the robot can stand (view_points.h): the same for every mount.
  CoverageHall(std::shared_ptr<const RayCaster> hall, const RobotConfig& robot, const CoverageConfig& config);

  // One look of every camera each 1 / rate_hz along the planned route; a vehicle that has not moved does not look again. `own_body`: the
  // vehicle's shape in its frame B; nullptr: nothing of it stands in the view. May be called from several threads.
  Coverage along_route(const Scenario& scenario, const RayCaster* own_body, FloorLooks* looks = nullptr) const;

  // The share of the planned route's time, in [0, 1], at which these cameras see most of the true objects' surfaces.
  double best_moment(const Scenario& scenario) const;

  // Points of the floor, viewable or not.
  const std::vector<SurfaceSample>& floor() const { return floor_; }
  double floor_spacing_m() const { return config_.floor_spacing_m; }

 private:
  std::shared_ptr<const RayCaster> hall_;
  CoverageConfig config_;
  std::vector<SurfaceSample> floor_;
  std::vector<std::vector<SurfaceSample>> objects_;
};

// The vehicle's own model (Scene::vehicle) by itself, in its frame B; nullptr where the scene has none.
std::shared_ptr<const RayCaster> own_body_of(const Scene& scene);

}  // namespace waretwin
