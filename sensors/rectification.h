// Undistorted pictures, as the maker's driver resamples them.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/lens.h"

namespace waretwin {

// Pixel (u, v) of the view shows what the lens has at its projection of the view's ray through (u, v).
class Rectification {
 public:
  // Throws Error where the view looks outside the lens's image by more than half a pixel.
  Rectification(const Lens& lens, const Intrinsics& view);

  // CV_8UC3, bilinear.
  cv::Mat colour(const cv::Mat& taken) const;
  // CV_16UC1, of the nearest pixel: labels never mix.
  cv::Mat labels(const cv::Mat& taken) const;
  // The lens's pixel whose label view pixel (u, v) has.
  cv::Point nearest(int u, int v) const;

 private:
  struct Source {
    std::int32_t first;    // of the four pixels around: the upper left one
    std::uint16_t fx, fy;  // towards the right and the lower ones, in 1/256

    std::int32_t nearest(int width) const { return first + (fx >= 128 ? 1 : 0) + (fy >= 128 ? width : 0); }
  };
  int width_, height_;              // of the view
  int taken_width_, taken_height_;  // of the lens's image
  std::vector<Source> sources_;     // row-major
};

}  // namespace waretwin
