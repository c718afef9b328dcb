// What of its surroundings a vehicle's sensors cannot see at an instant, on an empty floor.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scenario.h"
#include "sim/ray_caster.h"

namespace waretwin {

struct BlindZone {
  double floor_share = 0.0;       // of the floor within the radius around the vehicle's outline: seen by no depth camera
  std::optional<double> ahead_m;  // from the front edge to the nearest floor that is seen over at least half of the vehicle's width
  double laser_share = 0.0;       // of the directions around the vehicle: looked into by no laser
  std::vector<Eigen::Vector2f> seen, unseen;  // points of the floor in the vehicle's frame B, for pictures
  double spacing_m = 0.05;                    // between them
};

// `robot` gives the outline (a rectangle about the frame's origin), `own_body` what of the vehicle stands in the view (nullptr: nothing).
BlindZone blind_zone(const RobotConfig& robot, const SensorsConfig& sensors, const RayCaster* own_body, double radius_m);

}  // namespace waretwin
