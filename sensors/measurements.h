// What sensors deliver: the value types that every source yields and the mapper consumes. Each holds exactly what a recording holds.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"

namespace waretwin {

// One colour picture with depth registered to it. A source may leave the pictures empty and set `load` instead: frames that a mapper drops
// to keep its rate then cost nothing. Call load_pictures before reading them.
struct RgbdFrame {
  Stamp stamp = 0;
  // By which other files name the picture, where a clock was corrected since; nothing: `stamp`.
  std::optional<Stamp> named_stamp;
  std::string sensor;
  cv::Mat colour;  // height x width, CV_8UC3, BGR
  cv::Mat depth;   // height x width, CV_32FC1, metres along the optical axis (z), 0 = invalid; whole millimetres
  // As the depth camera itself took it, in its own lens (CameraConfig::depth_lens); empty where the source has none.
  cv::Mat native_depth;  // CV_32FC1, metres along the depth camera's optical axis, 0 = invalid; whole millimetres
  // Pose that came with the recording, if any. Never set by the simulation.
  std::optional<Pose> recorded_X_WC;
  // Makes or decodes colour and depth; valid until the stream's next event. Empty where the pictures are already there.
  std::function<void(RgbdFrame&)> load;
};

// Fills colour and depth where they are still to be made. Throws what the source throws (a damaged image: Error).
void load_pictures(RgbdFrame& frame);

// One turn of a 2D laser. Beam i points at angle_min + i * angle_increment (radians, counter-clockwise about the laser's z) and was
// measured at stamp + i * beam_interval.
struct LaserScan {
  Stamp stamp = 0;  // of beam 0
  std::string sensor;
  double angle_min = 0.0;
  double angle_increment = 0.0;
  Stamp beam_interval = 0;    // ns from one beam to the next
  double range_min = 0.0;     // metres
  double range_max = 0.0;     // metres
  std::vector<float> ranges;  // metres; 0 = no valid measurement
};

// Wheel odometry: pose of the base in a frame that starts anywhere and drifts. Only differences mean something.
struct OdometryReading {
  Stamp stamp = 0;
  std::string sensor;
  Pose X_OB = Pose::Identity();  // planar: z = roll = pitch = 0
};

// 16-bit millimetres (0 = invalid), the form of recordings, to metres and back. Decoding is value * 0.001f everywhere, so that a
// recorded and a live frame hold the same floats. Encoding rounds to nearest; beyond 65.535 m becomes 0.
cv::Mat depth_from_millimetres(const cv::Mat& millimetres);  // CV_16UC1 -> CV_32FC1
cv::Mat depth_to_millimetres(const cv::Mat& metres);         // CV_32FC1 -> CV_16UC1

}  // namespace waretwin
