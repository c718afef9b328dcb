#include "mapper/localise/simple_localisers.h"

#include "core/error.h"

namespace waretwin {

OdometryLocaliser::OdometryLocaliser(const StreamInfo& info) : X_WB_start_(info.X_WB_start) {
  if (!info.has_odometry) throw Error(info.source + ": no odometry in this stream; --poses odometry needs it");
}

void OdometryLocaliser::add(const OdometryReading& reading) {
  if (odometry_.empty()) X_OB_start_ = planar(reading.X_OB);
  odometry_.add(reading.stamp, planar(reading.X_OB));
}

Pose OdometryLocaliser::X_WB(const PlanarMotion& X_OB) const { return X_WB_start_ * upright(X_OB_start_.inverse() * X_OB); }

std::optional<Pose> OdometryLocaliser::pose_at(const RgbdFrame& frame) {
  if (odometry_.empty()) return X_WB_start_;
  return X_WB(odometry_.at(frame.stamp));
}

std::optional<Pose> OdometryLocaliser::current_pose() const {
  if (odometry_.empty()) return std::nullopt;
  return X_WB(odometry_.at(odometry_.newest()));
}

RecordedLocaliser::RecordedLocaliser(const StreamInfo& info) : cameras_(info.cameras) {
  if (!info.has_recorded_poses) throw Error(info.source + ": no recorded poses in this stream; --poses recorded needs them");
}

std::optional<Pose> RecordedLocaliser::pose_at(const RgbdFrame& frame) {
  if (!frame.recorded_X_WC) return std::nullopt;
  const auto camera = cameras_.find(frame.sensor);
  if (camera == cameras_.end()) throw Error("frame of camera '" + frame.sensor + "', which the stream does not describe");
  X_WB_ = *frame.recorded_X_WC * camera->second.X_BC.inverse();
  return X_WB_;
}

}  // namespace waretwin
