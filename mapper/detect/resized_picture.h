// Pictures made smaller or larger for a network, in training as in detection.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

namespace waretwin {

// By areas where it shrinks: every pixel counts, so that thin things neither flicker nor vanish. Halves first, which is several times as
// fast as any other area; a last step of less than a quarter is interpolated, which loses nothing to be seen. `to` is filled, at the size
// that it has.
inline void resize_picture(const cv::Mat& picture, cv::Mat& to) {
  cv::Mat from = picture;
  while (from.cols >= 2 * to.cols && from.rows >= 2 * to.rows) {
    cv::Mat half;
    cv::resize(from, half, {from.cols / 2, from.rows / 2}, 0, 0, cv::INTER_AREA);
    from = half;
  }
  const bool shrinks = 4 * from.cols > 5 * to.cols && 4 * from.rows > 5 * to.rows;
  cv::resize(from, to, to.size(), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
}

}  // namespace waretwin
