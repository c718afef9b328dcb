// How far the readings of a small patch of a depth image scatter about the plane through them.
#pragma once

#include <opencv2/core/mat.hpp>

#include "harness/noise/noise_config.h"

namespace waretwin {

enum class PatchVerdict { kPlane, kFewReadings, kStructured, kGrazing };

struct PlanePatch {
  PatchVerdict verdict = PatchVerdict::kFewReadings;
  int pixels = 0, readings = 0;
  double range_m = 0.0;  // mean of the readings along their rays; also where the verdict is no plane
  // Of planes only. Variances are unbiased (n - 3 degrees of freedom) and without that of whole millimetres (1/12 mm^2 along the optical
  // axis), so that a single one may be negative.
  double depth_m = 0.0;                       // along the optical axis, mean
  double cosine = 0.0;                        // of the incidence in the middle
  double variance_z = 0.0, variance_r = 0.0;  // m^2, along the optical axis and along the rays
  double correlation = 0.0;                   // of the residuals of horizontal neighbours
  // Share of the residuals' squares that goes when the patch is cut in two along the best straight line and each side gets a plane of its
  // own: near 1 for an edge or a bend, a tenth for independent errors.
  double structure = 0.0;
};

// `depth`: CV_32FC1, metres along the optical axis, 0 = invalid. `rays`: CV_32FC3 of its size, scaled to z = 1; (0, 0, 0) where a pixel
// has none. `area` is a square inside. A plane is one in inverse depth, which is linear in the rays; it is fitted by least squares of the
// depth. Readings far off the plane of least absolute residuals make a patch kStructured; whether `structure` is more than chance depends
// on how the camera's errors hang together and is left to the caller.
PlanePatch measure_patch(const cv::Mat& depth, const cv::Mat& rays, const cv::Rect& area, const NoiseConfig& config);

// Largest `structure` of a patch that is still a plane, where neighbours' errors have this correlation: as if it decayed by that factor a
// pixel along rows and columns, so that a reading counts as (1 - c)^2 / (1 + c)^2 independent ones.
double structure_limit(int readings, double correlation, const NoiseConfig& config);

}  // namespace waretwin
