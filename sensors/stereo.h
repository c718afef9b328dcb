// What a stereo depth camera makes of a hall: disparities by matching, their holes and errors, depth in whole millimetres. What its two
// cameras see comes from the simulation (sim/stereo_camera.h).
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/stamp.h"
#include "sensors/camera_config.h"

namespace waretwin {

// Of every pixel of the left camera, each image of its size.
struct StereoSignal {
  cv::Mat depth;    // CV_32FC1, metres along the optical axis, 0 = nothing there
  cv::Mat ambient;  // CV_32FC1, brightness by the hall's light over that of a white floor
  cv::Mat dots;     // CV_32FC1, brightness that a dot of the projector has here over one on a white surface straight ahead at 1 m
  cv::Mat seen;     // CV_8UC1, 1 = the right camera sees the point too
};

// Repetitive textures, which a matcher takes for their neighbours, and mismatches far from the truth are not modelled: where there is too
// little texture, there is no reading.
class StereoModel {
 public:
  // `sensor` is the camera's name; it keys the random numbers. The error that stays for the run is drawn here, from seed and sensor.
  StereoModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor);

  // depth_rays of the camera.
  const cv::Mat& rays() const { return rays_; }

  // Depth along the optical axis in the left camera's view: CV_32FC1, whole millimetres in the floats of depth_from_millimetres, 0 =
  // invalid. A reading depends on seed, sensor, stamp, pixel and the signals of its window alone.
  cv::Mat read(const StereoSignal& signal, Stamp stamp) const;

  // CV_32FC1: StereoConfig::texture_of the window around each pixel; at the border of the picture its outermost pixels go on.
  cv::Mat texture(const StereoSignal& signal) const;

  double calibration_error_px() const { return calibration_error_px_; }

 private:
  CameraConfig camera_;
  std::uint64_t seed_;
  std::string sensor_;
  cv::Mat rays_;
  double calibration_error_px_ = 0.0;
};

}  // namespace waretwin
