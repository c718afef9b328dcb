// A place on a way that somebody drives or walks.
#pragma once

#include <optional>

#include "core/fields.h"

namespace waretwin {

// Whoever goes there turns towards it, goes in a straight line, turns to `heading_deg` if given, and waits.
struct Waypoint {
  double x_m = 0.0, y_m = 0.0;
  // World yaw of the x axis of what moves after arrival; the first waypoint's is the start heading. None: as it arrived.
  std::optional<double> heading_deg;
  double wait_s = 0.0;
  bool reverse = false;  // goes backwards to this waypoint
  void visit(Fields& f);
};

}  // namespace waretwin
