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

void Mount::visit(Fields& f) {
  f("x_m", x_m, "position forward of the vehicle's centre", {.min = -100, .max = 100});
  f("y_m", y_m, "position to the left", {.min = -100, .max = 100});
  f("z_m", z_m, "height above the floor", {.min = -100, .max = 100});
  f("yaw_deg", yaw_deg, "turned to the left", {.min = -360, .max = 360});
  f("pitch_deg", pitch_deg, "turned downwards", {.min = -180, .max = 180});
  f("roll_deg", roll_deg, "turned to the right about the forward axis", {.min = -180, .max = 180});
}

}  // namespace waretwin
