// The colour vector of eq. (4).
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace waretwin {

// Joint histogram of hue (12 bins), saturation (4) and value (4) over the part of `box` that lies inside the picture (CV_8UC3, BGR), as
// shares of its pixels: 192 numbers that sum to 1, or all 0 where the box is outside. Few bins, so that shading and noise do not empty
// them.
std::vector<float> hsv_histogram(const cv::Mat& colour, const cv::Rect2f& box);

}  // namespace waretwin
