// Localisation without scan matching: wheel odometry alone, and poses that came with a recording.
#pragma once

#include <map>
#include <string>

#include "mapper/localise/localiser.h"
#include "mapper/localise/odometry_history.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// Start pose and wheel odometry. Drifts as the wheels do.
class OdometryLocaliser : public Localiser {
 public:
  // Throws Error where the stream has no odometry.
  explicit OdometryLocaliser(const StreamInfo& info);

  void add(const OdometryReading& reading) override;
  void add(const LaserScan&) override {}
  std::optional<Pose> pose_at(const RgbdFrame& frame) override;
  std::optional<Pose> current_pose() const override;  // at the newest reading
  bool localised() const override { return false; }

 private:
  Pose X_WB(const PlanarMotion& X_OB) const;

  Pose X_WB_start_;
  OdometryHistory odometry_;
  PlanarMotion X_OB_start_;  // first reading
};

// RgbdFrame::recorded_X_WC and the camera's mounting. A frame without a recorded pose has none here either and is dropped.
class RecordedLocaliser : public Localiser {
 public:
  // Throws Error where the stream has no recorded poses.
  explicit RecordedLocaliser(const StreamInfo& info);

  void add(const OdometryReading&) override {}
  void add(const LaserScan&) override {}
  std::optional<Pose> pose_at(const RgbdFrame& frame) override;
  std::optional<Pose> current_pose() const override { return X_WB_; }  // of the last frame that was asked for

 private:
  std::map<std::string, StreamInfo::Camera> cameras_;
  std::optional<Pose> X_WB_;
};

}  // namespace waretwin
