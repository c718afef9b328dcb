// Pictures that hang and glow in flats. 8-bit BGR.
#pragma once

#include <opencv2/core.hpp>

namespace waretwin::builder {

cv::Mat draw_landscape_screen();  // 16:9, what a television shows
cv::Mat draw_hills_painting();    // 4:3
cv::Mat draw_shapes_painting();   // 3:4

}  // namespace waretwin::builder
