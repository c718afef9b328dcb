// The route through a planned hall: from which places each conveyor is looked at, and the way between them.
#pragma once

#include <vector>

#include "scenes/generate/hall_plan.h"
#include "sensors/camera_config.h"

namespace waretwin::generate {

struct RouteWishes {
  double clearance_m = 0.10;
  double wait_s = 1.0;
  // How much closer to look at each conveyor, by index: 0 as usual; each step asks for more of the surface, from more places.
  std::vector<int> effort;
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  // the route begins at the free place nearest to it
  bool back_to_start = false;
};

// Fills plan.stops and plan.robot.route. A conveyor is looked at from two directions at least where the hall allows, from as many places
// as it takes to see its surface (boxes stand for things, the camera's depth field is its own), each time turned towards it and standing.
// The stops are driven to in a short round. Returns the indices of conveyors that no free place shows; the route is then empty.
std::vector<int> plan_route(HallPlan& plan, const CameraConfig& camera, const RouteWishes& wishes);

}  // namespace waretwin::generate
