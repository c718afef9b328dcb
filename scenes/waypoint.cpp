#include "scenes/waypoint.h"

namespace waretwin {

void Waypoint::visit(Fields& f) {
  f("x_m", x_m, "place in the world", {.min = -1e5, .max = 1e5, .required = true});
  f("y_m", y_m, "place in the world", {.min = -1e5, .max = 1e5, .required = true});
  f("heading_deg", heading_deg, "direction to turn to after arrival; on the first waypoint the start heading", {.min = -360, .max = 360});
  f("wait_s", wait_s, "time to stand there", {.min = 0, .max = 3600});
  f("reverse", reverse, "goes backwards to this place");
}

}  // namespace waretwin
