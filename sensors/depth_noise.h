// What a depth camera makes of an ideal depth image: Gaussian error that grows with distance, dropped pixels, the field and range of its
// mode, whole millimetres (data sheet values in sensors/camera_config.h).
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/stamp.h"
#include "sensors/camera_config.h"

namespace waretwin {

class DepthNoiseModel {
 public:
  // `sensor` is the camera's name; it keys the random numbers.
  DepthNoiseModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor);

  // Turns true depth (CV_32FC1 of the camera's size, continuous, metres along the optical axis, 0 or not finite = nothing there) into
  // the reading, in place: 0 where there is none, else whole millimetres in the floats of depth_from_millimetres. A reading depends on
  // seed, sensor, stamp, pixel and its true depth alone. With noise switched off, field, range and millimetre steps remain.
  void apply(cv::Mat& depth, Stamp stamp) const;

 private:
  CameraConfig camera_;
  std::uint64_t seed_;
  std::string sensor_;
  cv::Mat field_;
};

}  // namespace waretwin
