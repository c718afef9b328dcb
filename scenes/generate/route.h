// The route through a planned hall: from which places each conveyor is looked at, and the way between them.
#pragma once

#include <vector>

#include "scenes/generate/hall_plan.h"
#include "sensors/camera_config.h"

namespace waretwin::generate {

struct RouteWishes {
  double clearance_m = 0.10;
  double wait_s = 1.0;
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  // the route begins at the free place nearest to it
  bool back_to_start = false;
};

// For each conveyor by index, what a drive along the plan's route has missed of its surface; nothing where enough was seen.
using Missed = std::vector<std::vector<SurfacePatch>>;

// Fills plan.stops and plan.robot.route. A conveyor is looked at from two directions at least where the hall allows, from as many places
// as it takes to see its surface (boxes stand for things, the camera's depth field is its own), each time turned towards it and standing.
// The stops are driven to in a quick round. Returns the indices of conveyors that no free place shows; the route is then empty.
std::vector<int> plan_route(HallPlan& plan, const CameraConfig& camera, const RouteWishes& wishes);

// Adds stops from which the camera sees what was missed, up to three for each conveyor, and orders the route anew. False where no place
// shows any of it; the plan is then as it was.
bool extend_route(HallPlan& plan, const CameraConfig& camera, const RouteWishes& wishes, const Missed& missed);

}  // namespace waretwin::generate
