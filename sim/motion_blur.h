// The blur of a picture whose camera moves while it is exposed.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "sim/pixel_rays.h"

namespace waretwin {

// Sharp radiance (CV_32FC4) of the middles of exposures to what the pixels gather: each takes the mean along the way on which the picture
// passes over it. That way follows from the pixel's depth (CV_32FC1, 0 = infinitely far) and the motion of its row's camera during the
// exposure; it is a straight line through the pixel, on which every pixel counts for as long as it stays. Ways below one pixel are left
// out. `row_time`: from one row to the next over the exposure (rolling shutter; 0 = global): rows were not taken at the same time, which
// makes ways along the columns a little longer or shorter.
//
// The picture's own surfaces are taken as standing still (quality path blurs moving ones too), and a pixel knows its own surface's way
// only: at an edge between near and far, the edge is blurred by the way of the pixel's side.
cv::Mat motion_blurred(const cv::Mat& radiance, const cv::Mat& depth, const cv::Mat& directions, const std::vector<PixelRays::Row>& rows,
                       double row_time);

}  // namespace waretwin
