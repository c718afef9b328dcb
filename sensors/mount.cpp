#include "sensors/mount.h"

namespace waretwin {

Pose Mount::X_BL() const {
  Pose X_BL = Pose::Identity();
  X_BL.linear() = rotation_from_rpy(to_radians(roll_deg), to_radians(pitch_deg), to_radians(yaw_deg));
  X_BL.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return X_BL;
}

Pose Mount::X_BC() const {
  Pose X_BC = X_BL();
  X_BC.linear() = X_BC.linear() * optical_from_forward();
  return X_BC;
}

void BracketTolerance::visit(Fields& f) {
  f("position_sigma_m", position_sigma_m, "standard deviation of each axis of its position", {.min = 0, .max = 1});
  f("angle_sigma_deg", angle_sigma_deg, "standard deviation of each axis of its direction", {.min = 0, .max = 45});
}

void MountVibration::visit(Fields& f) {
  f("position_rms_m", position_rms_m, "root mean square of each axis of its position", {.min = 0, .max = 1});
  f("angle_rms_deg", angle_rms_deg, "root mean square of each axis of its direction", {.min = 0, .max = 45});
  f("frequency_hz", frequency_hz, "middle of the band that it shakes in", {.min = 0.1, .max = 1000});
  f("full_speed_mps", full_speed_mps, "speed from which on it shakes in full; in proportion below", {.min = 0.01, .max = 100});
}

void Mount::visit(Fields& f) {
  f("x_m", x_m, "position forward of the vehicle's centre", {.min = -100, .max = 100});
  f("y_m", y_m, "position to the left", {.min = -100, .max = 100});
  f("z_m", z_m, "height above the floor", {.min = -100, .max = 100});
  f("yaw_deg", yaw_deg, "turned to the left", {.min = -360, .max = 360});
  f("pitch_deg", pitch_deg, "turned downwards", {.min = -180, .max = 180});
  f("roll_deg", roll_deg, "turned to the right about the forward axis", {.min = -180, .max = 180});
  f.group("bracket", bracket, "how far the built bracket is off the drawn one");
  f.group("vibration", vibration, "how it shakes while the vehicle rolls");
}

}  // namespace waretwin
