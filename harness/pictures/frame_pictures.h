// What the camera saw in a mapped frame, and what the mapper made of it.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "mapper/mapper.h"

namespace waretwin {

// The colour picture with the detector's boxes, the pixels of the segmented objects and the cuboids of the map as seen from here. BGR.
cv::Mat draw_frame(const Mapper::FrameResult& result, const ObjectList& objects, const Intrinsics& intrinsics);

// Depth in colours from near (red) to far (blue) with the range as text; black where there is none. BGR.
cv::Mat draw_depth(const cv::Mat& depth, double near_m, double far_m);

// Side by side and half as large: ideal depth, sensor depth, and the error where both are, from blue (5 cm too near) over white to red (5
// cm too far); dark grey where only the sensor has nothing. BGR.
cv::Mat draw_depth_error(const cv::Mat& sensor, const cv::Mat& ideal, double near_m, double far_m);

}  // namespace waretwin
