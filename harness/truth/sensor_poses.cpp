#include "harness/truth/sensor_poses.h"

namespace waretwin {

SensorPoses::SensorPoses(const SimulatedStream& stream, const SensorsConfig& sensors) : stream_(stream) {
  for (const auto& [name, camera] : sensors.cameras) {
    if (stream.info().cameras.at(name).native) X_CD_[name] = camera.X_CD();
  }
}

void SensorPoses::add(const SensorEvent& event) {
  const Stamp stamp = stamp_of(event);
  if (const auto* frame = std::get_if<RgbdFrame>(&event)) {
    const Pose X_WC = stream_.true_X_WC(frame->sensor, stamp);
    poses_["cameras/" + frame->sensor + ".tum"].push_back({stamp, X_WC});
    const auto depth = X_CD_.find(frame->sensor);
    if (depth != X_CD_.end()) poses_["cameras/" + frame->sensor + ".depth.tum"].push_back({stamp, X_WC * depth->second});
  } else if (const auto* scan = std::get_if<LaserScan>(&event)) {
    poses_["lasers/" + scan->sensor + ".tum"].push_back({stamp, stream_.true_X_WL(scan->sensor, stamp)});
  } else {
    poses_[std::get<OdometryReading>(event).sensor + ".tum"].push_back({stamp, stream_.true_X_WB(stamp)});
  }
}

}  // namespace waretwin
