// Depth from its own camera into another camera's view, as the maker's software does it for the colour picture.
#pragma once

#include <opencv2/core/mat.hpp>

#include "core/pose.h"
#include "sensors/lens.h"

namespace waretwin {

// Every square of four neighbouring depth pixels becomes two triangles in space, which are drawn into the view with the nearer one in
// front; a triangle with an invalid corner, or whose corners' depths differ by more than 5 % (and 5 mm), is left out: nothing is known
// between a foreground edge and what lies behind it. What the depth camera does not see stays 0.
class DepthRegistration {
 public:
  // `rays`: CV_32FC3, the depth camera's ray of each of its pixels scaled to z = 1, zero where it has none (TimeOfFlightModel::rays).
  // X_CD: the depth camera D in the frame of the view's camera C.
  DepthRegistration(const cv::Mat& rays, const Pose& X_CD, const Lens& view);

  // Native depth (CV_32FC1, metres, 0 = invalid) to depth in the view: CV_32FC1, its size, metres along its axis, whole millimetres as in
  // depth_from_millimetres, 0 = unknown. The same at any thread count.
  cv::Mat operator()(const cv::Mat& native) const;

 private:
  cv::Mat rays_;
  Pose X_CD_;
  Lens view_;
};

}  // namespace waretwin
