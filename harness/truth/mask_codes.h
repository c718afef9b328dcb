// Masks as text: run lengths and polygons as COCO writes them.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace waretwin {

// A mask as COCO's uncompressed run lengths: pixels column by column, counts of zeros and of others in turn, beginning with zeros.
// `mask` (CV_8UC1) stands at `place` in a picture of size `size` that is zero elsewhere.
std::vector<int> run_lengths(const cv::Mat& mask, const cv::Rect& place, const cv::Size& size);

// The same numbers as COCO's compressed text: six bits a letter, from the third on as differences to the last but one.
std::string compressed_runs(const std::vector<int>& runs);

// Outlines along the pixels' edges, one a connected piece (across sides, not corners), as x0, y0, x1, y1 ... in the picture. The hole of a
// piece is part of its polygon, joined by a seam that is walked there and back: whoever fills by the even-odd rule, as COCO's own tools
// do, gets the mask. With tolerance_px > 0, points that lie no farther than that from the line without them are left out.
std::vector<std::vector<double>> outlines(const cv::Mat& mask, const cv::Point& place, double tolerance_px);

}  // namespace waretwin
