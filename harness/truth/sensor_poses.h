// Where every sensor was at each of its instants.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/score/trajectory_file.h"
#include "sensors/sensors_config.h"
#include "sim/simulated_stream.h"

namespace waretwin {

// Takes the events of a simulated drive as they come.
class SensorPoses {
 public:
  // The stream must outlive this object and be the one that the events come from.
  SensorPoses(const SimulatedStream& stream, const SensorsConfig& sensors);
  void add(const SensorEvent& event);

  // By file name below truth_poses/, each in order of stamps:
  //   cameras/NAME.tum        X_WC at each frame's stamp, mapped or not
  //   cameras/NAME.depth.tum  X_WD of its depth camera, where that has a lens of its own
  //   lasers/NAME.tum         X_WL at each scan's first beam
  //   odometry.tum            X_WB at each reading
  const std::map<std::string, std::vector<StampedPose>>& poses() const { return poses_; }

 private:
  const SimulatedStream& stream_;
  std::map<std::string, Pose> X_CD_;  // by camera
  std::map<std::string, std::vector<StampedPose>> poses_;
};

}  // namespace waretwin
