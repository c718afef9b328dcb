// What a time-of-flight depth camera makes of the light that comes back: systematic and random error, the maker's rules for invalid
// pixels, whole millimetres. The light itself comes from the simulation (sim/time_of_flight_camera.h).
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/stamp.h"
#include "sensors/camera_config.h"

namespace waretwin {

// The summed phasors of every pixel, each image CV_32FC1 of the depth camera's size.
struct TimeOfFlightSignal {
  cv::Mat range;      // metres along the pixel's ray; 0 = nothing came back
  cv::Mat signal;     // length of the sum, relative (TimeOfFlightConfig)
  cv::Mat coherence;  // of what the pixel itself saw: length of the sum over the sum of lengths, in [0, 1]
  cv::Mat indirect;   // light that came by way of another surface over light that came straight back
};

class TimeOfFlightModel {
 public:
  // `sensor` is the camera's name; it keys the random numbers. The phases of the systematic error are drawn here, from seed and sensor.
  TimeOfFlightModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor);

  // depth_rays of the camera.
  const cv::Mat& rays() const { return rays_; }

  // Depth along the optical axis in the depth camera's own view: CV_32FC1, whole millimetres in the floats of depth_from_millimetres,
  // 0 = invalid. A reading depends on seed, sensor, stamp, pixel and the signals of the pixel and its neighbours alone.
  cv::Mat read(const TimeOfFlightSignal& signal, Stamp stamp) const;

  // Systematic error in metres of a range, constant in a run: two sine waves over the range (periods of an eighth and a fourth of
  // the farthest range) whose root mean square is wiggle_rms_m and whose largest value is below twice that.
  double wiggle(double range) const;

 private:
  void remove_outliers(cv::Mat& depth) const;

  CameraConfig camera_;
  std::uint64_t seed_;
  std::string sensor_;
  cv::Mat rays_;
  double wiggle_phase_[2] = {0.0, 0.0};
};

}  // namespace waretwin
