// Wheel odometry as configuration. The paper's authors found theirs poor enough to replace it by the laser.
#pragma once

#include "core/fields.h"

namespace waretwin {

struct OdometryNoise {
  bool enabled = true;
  // Constant in a run, normal with these standard deviations: relative error of distances and of turns.
  double distance_scale_sd = 0.015;
  double turn_scale_sd = 0.02;
  // Random walk: standard deviation after 1 m or 1 rad, growing with the square root of either.
  double distance_sd_m = 0.01;        // along the way, per square root of a metre driven
  double turn_sd_per_m_rad = 0.01;    // heading, per square root of a metre driven
  double turn_sd_per_rad_rad = 0.02;  // heading, per square root of a radian turned
  void visit(Fields& f);
};

struct OdometryConfig {
  bool enabled = true;
  double rate_hz = 50.0;
  OdometryNoise noise;
  void visit(Fields& f);
};

}  // namespace waretwin
