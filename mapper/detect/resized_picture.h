// Pictures made smaller or larger for a network, in training as in detection.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

namespace waretwin {

// By areas where it shrinks: every pixel counts, so that thin things neither flicker nor vanish. `to` is filled, at the size that it has.
inline void resize_picture(const cv::Mat& picture, cv::Mat& to) {
  const bool shrinks = to.cols < picture.cols && to.rows < picture.rows;
  cv::resize(picture, to, to.size(), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
}

}  // namespace waretwin
