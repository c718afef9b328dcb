// Stage 1 of the pipeline: where the vehicle stands.
#pragma once

#include <optional>

#include "core/pose.h"
#include "sensors/measurements.h"

namespace waretwin {

class Localiser {
 public:
  virtual ~Localiser() = default;
  virtual void add(const OdometryReading& reading) = 0;
  virtual void add(const LaserScan& scan) = 0;
  // X_WB at a camera frame, from what was added so far; nothing while no pose is known (the frame is then dropped and counted).
  virtual std::optional<Pose> pose_at(const RgbdFrame& frame) = 0;
  // X_WB after the newest scan (or odometry reading, where there are no scans); what trajectory.tum is made of.
  virtual std::optional<Pose> current_pose() const = 0;
  // Whether what that pose rests on is the newest scan, not odometry alone. True where there is nothing to match.
  virtual bool localised() const { return true; }
  // Covariance of (x, y, yaw) of that pose in W, metres and radians; nothing where the localiser does not know.
  virtual std::optional<Eigen::Matrix3d> covariance() const { return std::nullopt; }
};

}  // namespace waretwin
