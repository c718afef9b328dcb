// The part of a colour image in which a depth camera measures.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "sensors/camera_config.h"

namespace waretwin {

// Whether the depth camera's own ray (x, y, 1) lies in its field. A hexagon has flat sides above and below, half as long as it is wide, and
// its outermost corners on the left and right at half height (Azure Kinect's narrow illumination mask).
bool inside_outline(const DepthField& field, double x, double y);

// Whether a direction in the colour camera's frame (any length, z > 0) lies in the depth field. The two lenses count as one point: the
// 32 mm between them shift the edge by 2 deg at 1 m.
bool in_depth_field(const DepthField& field, const Eigen::Vector3d& ray_C);

// CV_8UC1 of the colour image's size: 255 in the depth field, 0 outside.
cv::Mat depth_field_mask(const CameraConfig& camera);

// What a camera with a depth lens of its own measures along: CV_32FC3 of the depth image's size, each pixel's ray scaled to z = 1; (0, 0,
// 0) outside the field.
cv::Mat depth_rays(const CameraConfig& camera);

}  // namespace waretwin
