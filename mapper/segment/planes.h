// The planes of one frame: multi-plane segmentation of the organised cloud (Trevor et al. 2013).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "mapper/segment/segment_config.h"
#include "sensors/intrinsics.h"

namespace waretwin {

struct DetectedPlane {
  Eigen::Vector3d normal_C = Eigen::Vector3d::Zero();    // unit, towards the camera
  double distance = 0.0;                                 // metres from the camera: normal_C . p_C + distance = 0
  Eigen::Vector3d centroid_C = Eigen::Vector3d::Zero();  // metres, mean of the inliers
  int inliers = 0;                                       // pixels of the thinned picture
};

// Depth (CV_32FC1, metres, 0 = invalid) seen by the camera; every config.stride-th pixel is looked at. Normals by integral images, planes
// by PCL's OrganizedMultiPlaneSegmentation with its co-planarity comparator. Largest plane first.
std::vector<DetectedPlane> detect_planes(const cv::Mat& depth, const Intrinsics& intrinsics, double depth_min_m, double depth_max_m,
                                         const PlaneConfig& config);

}  // namespace waretwin
