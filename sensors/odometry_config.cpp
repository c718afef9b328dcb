#include "sensors/odometry_config.h"

namespace waretwin {

void OdometryNoise::visit(Fields& f) {
  f("enabled", enabled, "false makes the odometry exact");
  f("distance_scale_sd", distance_scale_sd, "relative error of distances, drawn once per run", {.min = 0, .max = 1});
  f("turn_scale_sd", turn_scale_sd, "relative error of turns, drawn once per run", {.min = 0, .max = 1});
  f("distance_sd_m", distance_sd_m, "random error of the distance after one metre", {.min = 0, .max = 1});
  f("turn_sd_per_m_rad", turn_sd_per_m_rad, "random error of the heading after one metre", {.min = 0, .max = 1});
  f("turn_sd_per_rad_rad", turn_sd_per_rad_rad, "random error of the heading after one radian", {.min = 0, .max = 1});
}

void OdometryConfig::visit(Fields& f) {
  f("enabled", enabled, "false leaves the vehicle without odometry");
  f("rate_hz", rate_hz, "readings a second", {.min = 0.1, .max = 10000});
  f.group("noise", noise, "slip and scale errors");
}

}  // namespace waretwin
