#include "sensors/odometry_model.h"

#include <cmath>

#include "core/random.h"

namespace waretwin {

namespace {

// Readings come in whole nanometres and nanoradians, so that nine decimals of text hold them exactly.
double stepped(double value) { return std::round(value * 1e9) / 1e9; }

}  // namespace

OdometryModel::OdometryModel(const OdometryConfig& odometry, std::uint64_t seed, const std::string& sensor)
    : noise_(odometry.noise), seed_(seed), sensor_(sensor) {
  if (!noise_.enabled) return;
  const RandomStream random(seed, sensor, "scale");
  distance_scale_ = 1.0 + noise_.distance_scale_sd * random.normal(0);
  turn_scale_ = 1.0 + noise_.turn_scale_sd * random.normal(1);
}

OdometryReading OdometryModel::advance(Stamp stamp, const Pose& X_WB) {
  if (last_X_WB_) {
    const double yaw_before = yaw_of(*last_X_WB_);
    const double turn = wrap_angle(yaw_of(X_WB) - yaw_before);
    const Eigen::Vector2d step = (Eigen::Rotation2Dd(-yaw_before) * (X_WB.translation() - last_X_WB_->translation()).head<2>());
    const double distance = step.norm();
    double reckoned_turn = turn;
    double stretch = 1.0;
    if (noise_.enabled) {
      const RandomStream random(seed_, sensor_, "slip", stamp);
      reckoned_turn = turn * turn_scale_ + noise_.turn_sd_per_m_rad * std::sqrt(distance) * random.normal(0) +
                      noise_.turn_sd_per_rad_rad * std::sqrt(std::abs(turn)) * random.normal(1);
      if (distance > 0.0) stretch = distance_scale_ + noise_.distance_sd_m * random.normal(2) / std::sqrt(distance);
    }
    // Half of the heading error already shows in the direction of the step.
    const Eigen::Vector2d moved = Eigen::Rotation2Dd(yaw_ + 0.5 * (reckoned_turn - turn)) * (stretch * step);
    x_ += moved.x();
    y_ += moved.y();
    yaw_ = wrap_angle(yaw_ + reckoned_turn);
  }
  last_X_WB_ = X_WB;
  OdometryReading reading;
  reading.stamp = stamp;
  reading.sensor = sensor_;
  reading.X_OB = make_upright_pose(stepped(x_), stepped(y_), 0.0, stepped(yaw_));
  return reading;
}

}  // namespace waretwin
