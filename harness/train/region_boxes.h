// A region layer's numbers as boxes, as Darknet and OpenCV read them.
#pragma once

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <vector>

#include "harness/train/network_plan.h"

namespace waretwin::train {

constexpr float kLargestExponent = 8.0f;  // boxes some thousand times their anchor are none; keeps exp finite

// x, y, w, h of one cell and anchor as left, top, width, height in shares of the picture.
cv::Rect2f region_box(const float* numbers, const NetworkPlan& plan, std::int64_t anchor, std::int64_t row, std::int64_t column);

struct ScoredBox {
  int class_index = 0;
  cv::Rect2f share;
  float score = 0.0f;
};

// One picture's output, (anchors, 5 + classes, rows, columns) without gaps: boxes of at least `score`, cut off at the picture's edges,
// without those that overlap a better one of their class by more than `nms_iou`; best first.
std::vector<ScoredBox> region_boxes(const float* output, const NetworkPlan& plan, float score, float nms_iou);

}  // namespace waretwin::train
