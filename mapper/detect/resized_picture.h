// Pictures made smaller or larger for a network, in training as in detection.
#pragma once

#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

namespace waretwin {

// By areas where it shrinks: every pixel counts, so that thin things neither flicker nor vanish. Halves first, which is several times as
// fast as any other area; a last step to four fifths of a side or more is interpolated, which loses nothing to be seen. `to` is filled, at
// the size that it has.
inline void resize_picture(const cv::Mat& picture, cv::Mat& to) {
  cv::Mat from = picture;
  const auto shrink = [&from](const cv::Size& size) {
    cv::Mat smaller;
    cv::resize(from, smaller, size, 0, 0, cv::INTER_AREA);
    from = smaller;
  };
  // Each side by itself: the network's proportions need not be the picture's.
  while (from.cols >= 2 * to.cols || from.rows >= 2 * to.rows)
    shrink({from.cols >= 2 * to.cols ? from.cols / 2 : from.cols, from.rows >= 2 * to.rows ? from.rows / 2 : from.rows});
  const cv::Size least(std::min(from.cols, to.cols), std::min(from.rows, to.rows));
  const bool by_area = 4 * from.cols > 5 * least.width || 4 * from.rows > 5 * least.height;
  if (by_area && least == to.size()) return cv::resize(from, to, least, 0, 0, cv::INTER_AREA);
  if (by_area) shrink(least);
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_LINEAR);
}

}  // namespace waretwin
