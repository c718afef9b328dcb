// Masks as polygons, as COCO writes them. Run lengths: mapper/detect/mask_runs.h.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace waretwin {

// Outlines along the pixels' edges, one a connected piece (across sides, not corners), as x0, y0, x1, y1 ... in the picture. The hole of a
// piece is part of its polygon, joined by a seam that is walked there and back: whoever fills by the even-odd rule, as COCO's own tools
// do, gets the mask. With tolerance_px > 0, points that lie no farther than that from the line without them are left out.
std::vector<std::vector<double>> outlines(const cv::Mat& mask, const cv::Point& place, double tolerance_px);

}  // namespace waretwin
