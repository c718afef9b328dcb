#include "scenes/drive_config.h"

namespace waretwin {

void DriveConfig::visit(Fields& f) {
  f("model", model, "wheels: slip and load of real wheels; exact: the route without error", {.choices = {"wheels", "exact"}});
  f("mass_kg", mass_kg, "of the empty vehicle", {.min = 1, .max = 1e4});
  f("payload_kg", payload_kg, "of the load that it carries", {.min = 0, .max = 1e4});
  f("payload_x_m", payload_x_m, "middle of the load, forward of the vehicle's", {.min = -5, .max = 5});
  f("payload_y_m", payload_y_m, "middle of the load, left of the vehicle's", {.min = -5, .max = 5});
  f("payload_z_m", payload_z_m, "middle of the load, above the floor", {.min = 0, .max = 5});
  f("wheel_radius_m", wheel_radius_m, "of the driven wheels under the empty vehicle", {.min = 0.01, .max = 1});
  f("track_m", track_m, "distance between the driven wheels", {.min = 0.05, .max = 10});
  f("floor_friction", floor_friction, "beyond this share of its load a wheel skids", {.min = 0.01, .max = 2});
  f("creep_stiffness", creep_stiffness, "a gripping wheel slips by traction / (this * load)", {.min = 1, .max = 1e4});
  f("tyre_stiffness_n_m", tyre_stiffness_n_m, "load that flattens a tyre by a metre", {.min = 1e3, .max = 1e9});
  f("caster_share", caster_share, "share of the empty vehicle's weight on its casters", {.min = 0.05, .max = 0.9});
}

}  // namespace waretwin
