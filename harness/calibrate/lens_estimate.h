// The camera's own intrinsics, from the same corners.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/fields.h"
#include "harness/calibrate/checker_board.h"
#include "sensors/intrinsics.h"

namespace waretwin {

struct LensConfig {
  bool estimate = false;
  bool distortion = true;  // k1, k2, p1, p2; false: they are 0
  void visit(Fields& f);
};

struct LensEstimate {
  // fx, fy, cx, cy in pixels, then k1, k2, p1, p2 as OpenCV's; each with its standard deviation, 0 where it was not estimated.
  Eigen::Matrix<double, 8, 1> values = Eigen::Matrix<double, 8, 1>::Zero(), sigmas = Eigen::Matrix<double, 8, 1>::Zero();
  double rms_px = 0.0;
  int poses = 0;
};

// Zhang's method (cv::calibrateCamera) over the corners of all poses; begins with `given`. Throws Error for fewer than three poses.
LensEstimate estimate_lens(const std::vector<std::vector<Eigen::Vector2d>>& corners, const CheckerBoard& board, const Intrinsics& given,
                           const LensConfig& config);

}  // namespace waretwin
