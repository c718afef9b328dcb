// The box shapes that a region layer starts from (Redmon and Farhadi 2017, section 2, "dimension clusters").
#pragma once

#include <vector>

namespace waretwin::train {

struct BoxShape {
  double width = 0.0, height = 0.0;  // in one unit for all: cells of the output for anchors
};

// Overlap of two boxes with one centre.
double shape_iou(const BoxShape& a, const BoxShape& b);

// `count` shapes, by area, that minimise the mean of 1 - IoU to the nearest one: k-means from spread-out starts (k-means++), the same for
// the same input. With fewer different shapes than asked for, the rest are larger and smaller versions of them. `shapes` is not empty.
std::vector<BoxShape> find_anchors(const std::vector<BoxShape>& shapes, int count);

// Mean over shapes of the IoU with the best anchor.
double mean_best_iou(const std::vector<BoxShape>& shapes, const std::vector<BoxShape>& anchors);

}  // namespace waretwin::train
