// What a colour camera makes of the light that reaches its lens: falloff towards the corners, false white, noise, the tone curve. The
// light itself comes from the simulation (sim/colour_camera.h).
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/stamp.h"
#include "sensors/camera_config.h"

namespace waretwin {

class ColourModel {
 public:
  // `sensor` is the camera's name; it keys the random numbers. The white balance's error is drawn here, from seed and sensor. Throws Error
  // for a lens some of whose pixels see nothing.
  ColourModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor);

  // CV_32FC2, rows x cols of the camera, in its own lens (CameraConfig::colour_lens): the pixel's ray (x, y, 1).
  const cv::Mat& rays() const { return rays_; }

  // Linear radiance in the camera's own lens (CV_32FC4: red, green, blue, unused; 1 = white) to its picture: CV_8UC3, BGR. A pixel depends
  // on seed, sensor, stamp, its place and its radiance alone. Without any effect it is the tone curve's.
  cv::Mat picture(const cv::Mat& radiance, Stamp stamp) const;
  // The same before the tone curve: linear, noise may go below 0; CV_32FC3, red, green, blue.
  cv::Mat sensed(const cv::Mat& radiance, Stamp stamp) const;

  // Gains of red, green, blue, constant in a run: 1 + error * uniform(-1, 1), green 1.
  const float* white_balance() const { return gain_; }

 private:
  template <class Sink>
  void sense(const cv::Mat& radiance, Stamp stamp, const Sink& sink) const;

  ColourConfig config_;
  std::uint64_t seed_;
  std::string sensor_;
  cv::Mat rays_;
  std::vector<float> falloff_;  // a value a pixel; empty without vignetting
  float gain_[3] = {1.0f, 1.0f, 1.0f};
};

}  // namespace waretwin
