// The route through a planned hall: from which places each object is looked at, and the way between them.
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

// Fills plan.stops and plan.robot.route. An object is looked at from two directions at least where the hall allows, from as many places
// as it takes to see its surface (boxes stand for things, the camera's depth field is its own), each time turned towards it and standing.
// The stops are driven to in a quick round. Returns the indices of objects that no free place shows; the route is then empty.
std::vector<int> plan_route(HallPlan& plan, const CameraConfig& camera, const RouteWishes& wishes);

// Places from which the camera may see more of an object, turned to it or to one of its ends, apart from the route's own stops; farther
// and flatter than what plan_route takes. For who can tell how much they show.
std::vector<Stop> possible_stops(const HallPlan& plan, const RouteWishes& wishes, std::size_t object);

// Adds stops, and orders the route anew.
void add_stops(HallPlan& plan, const RouteWishes& wishes, const std::vector<Stop>& stops);

}  // namespace waretwin::generate
