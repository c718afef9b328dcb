// Depth pictures cut into convex surfaces (Furrer et al. 2018, "Incremental Object Database"; Grinvald et al. 2019, section III-A).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "mapper/segment/geometric_config.h"
#include "sensors/intrinsics.h"

namespace waretwin {

struct ConvexSegments {
  int width = 0, height = 0;         // of the thinned picture
  int count = 0;                     // segments
  std::vector<std::int32_t> labels;  // row by row: 1 to count in the order of their first pixels, 0 = in no segment
};

// A pixel is an edge where a neighbour is turned against it in a concave way (each of both lies before the other's plane, on the whole), or
// where a direct neighbour lies off its plane (a step). What is connected without edges is a segment; small ones are dropped, and edge
// pixels are given back to the nearest segment unless a step lies between. Distances across the plane and not along the ray decide about
// steps, so that a floor seen flat is none. `depth` in metres (CV_32FC1), 0 = invalid; outside [depth_min, depth_max] is nothing. The same
// at any thread count.
ConvexSegments find_convex_segments(const cv::Mat& depth, const Intrinsics& intrinsics, double depth_min, double depth_max,
                                    const GeometricConfig& config);

// What a pixel sees of a surface, camera frame.
struct SurfacePoint {
  Eigen::Vector3f p = Eigen::Vector3f::Zero();       // metres, on the fitted plane; as measured where none could be fitted; 0 without depth
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // towards the camera; 0 where none could be fitted
};

// By pixel of an organised picture, a plane fitted to the window around it, without the pixels whose depth differs by more than
// depth_share. Inverse depth is a linear function of the pixel on a plane, so that a fit of it is right at any incidence. Shown for tests.
std::vector<SurfacePoint> fit_surface(const cv::Mat& depth, const Intrinsics& intrinsics, int window_px, double depth_share);

}  // namespace waretwin
