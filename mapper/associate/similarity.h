// What the association compares (eqs. 3 and 4 of the paper).
#pragma once

#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "core/cuboid.h"
#include "sensors/intrinsics.h"

namespace waretwin {

// Eq. (3): in [0, 1]; 0 where both boxes are empty.
double iou_2d(const cv::Rect2f& a, const cv::Rect2f& b);

// Eq. (4) read as the normalised correlation A.B / (|A| |B|), in [0, 1] for histograms; 0 where one is empty or all zero.
double normalised_correlation(const std::vector<float>& a, const std::vector<float>& b);
// Eq. (4) as printed: A.B / sqrt(|A|^2 + |B|^2). It depends on the scale of the vectors.
double literal_correlation(const std::vector<float>& a, const std::vector<float>& b);

// The 2D box around a cuboid as the camera sees it, cut off at the picture's edges; nothing where it is out of view. Edges that
// pass the camera are clipped 1 cm in front of it.
std::optional<cv::Rect2f> projected_box(const Cuboid& cuboid, const Pose& X_WC, const Intrinsics& intrinsics);

}  // namespace waretwin
