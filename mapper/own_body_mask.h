// Keeps what a sensor sees of its own vehicle out of the map.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "sensors/sensor_stream.h"

namespace waretwin {

// Readings inside StreamInfo::own_body_B become invalid; where that is not set nothing changes.
class OwnBodyMask {
 public:
  explicit OwnBodyMask(const StreamInfo& info);

  // Registered and native depth. Throws Error for a camera that the stream does not name.
  void mask(RgbdFrame& frame) const;
  void mask(LaserScan& scan) const;

 private:
  // Where each pixel's ray goes through the box: CV_32FC2, depths along the optical axis; (0, 0) where it does not.
  static cv::Mat stretches(const Lens& lens, const Pose& X_BC, const Eigen::AlignedBox3d& box);

  std::optional<Eigen::AlignedBox3d> box_B_;
  std::map<std::string, cv::Mat> registered_, native_;  // by camera
  std::map<std::string, Pose> X_BL_;                    // by laser
};

}  // namespace waretwin
