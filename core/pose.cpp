#include "core/pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waretwin {

double wrap_angle(double radians) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  double wrapped = std::remainder(radians, kTurn);
  if (wrapped <= -std::numbers::pi) wrapped += kTurn;
  return wrapped;
}

double angle_distance(double a, double b, double period) { return std::abs(std::remainder(a - b, period)); }

double to_radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }
double to_degrees(double radians) { return radians * (180.0 / std::numbers::pi); }

Pose make_upright_pose(double x, double y, double z, double yaw) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

Eigen::Matrix3d rotation_from_rpy(double roll, double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

double yaw_of(const Pose& X_AB) { return std::atan2(X_AB.linear()(1, 0), X_AB.linear()(0, 0)); }

Eigen::Matrix3d optical_from_forward() {
  Eigen::Matrix3d R_BC;
  // Columns: the camera's x (right), y (down) and z (forward) in the vehicle's axes.
  R_BC << 0, 0, 1,  //
      -1, 0, 0,     //
      0, -1, 0;
  return R_BC;
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
  const Eigen::Quaterniond q_a(a.linear());
  const Eigen::Quaterniond q_b(b.linear());
  Pose pose = Pose::Identity();
  pose.linear() = q_a.slerp(t, q_b).normalized().toRotationMatrix();
  pose.translation() = (1.0 - t) * a.translation() + t * b.translation();
  return pose;
}

double rotation_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.linear().transpose() * b.linear())).angle();
}

Pose orthonormalised(const Pose& X_AB) {
  Pose pose = X_AB;
  pose.linear() = Eigen::Quaterniond(X_AB.linear()).normalized().toRotationMatrix();
  return pose;
}

}  // namespace waretwin
