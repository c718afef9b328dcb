// Wheel odometry: what the wheels say of the true motion. Scale errors stay for the run (wheel radius, track width); slip is a random walk
// in distance and heading (sensors/odometry_config.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sensors/measurements.h"
#include "sensors/odometry_config.h"

namespace waretwin {

class OdometryModel {
 public:
  // `sensor` is the odometry's name; it keys the random numbers. Scale errors are drawn here, from seed and sensor.
  OdometryModel(const OdometryConfig& odometry, std::uint64_t seed, const std::string& sensor);

  // The reading at `stamp`, the vehicle truly being at X_WB (its x, y and yaw count). The first reading is the origin of the odometry's
  // own frame. Call with increasing stamps, often enough that the way between two calls is nearly straight.
  OdometryReading advance(Stamp stamp, const Pose& X_WB);

  double distance_scale() const { return distance_scale_; }
  double turn_scale() const { return turn_scale_; }

 private:
  OdometryNoise noise_;
  std::uint64_t seed_;
  std::string sensor_;
  double distance_scale_ = 1.0;
  double turn_scale_ = 1.0;
  std::optional<Pose> last_X_WB_;
  double x_ = 0.0, y_ = 0.0, yaw_ = 0.0;  // reckoned pose in the odometry's frame
};

}  // namespace waretwin
