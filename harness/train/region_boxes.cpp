#include "harness/train/region_boxes.h"

#include <algorithm>
#include <cmath>

#include "harness/train/sample.h"

namespace waretwin::train {
namespace {

float logistic(float x) { return 1.0f / (1.0f + std::exp(-x)); }

}  // namespace

cv::Rect2f region_box(const float* numbers, const NetworkPlan& plan, std::int64_t anchor, std::int64_t row, std::int64_t column) {
  const auto columns = static_cast<float>(plan.columns()), rows = static_cast<float>(plan.rows());
  const float cx = (logistic(numbers[0]) + static_cast<float>(column)) / columns,
              cy = (logistic(numbers[1]) + static_cast<float>(row)) / rows;
  const float w = std::exp(std::min(numbers[2], kLargestExponent)) * static_cast<float>(plan.anchors[anchor].width) / columns;
  const float h = std::exp(std::min(numbers[3], kLargestExponent)) * static_cast<float>(plan.anchors[anchor].height) / rows;
  return {cx - 0.5f * w, cy - 0.5f * h, w, h};
}

std::vector<ScoredBox> region_boxes(const float* output, const NetworkPlan& plan, float score, float nms_iou) {
  const std::int64_t rows = plan.rows(), columns = plan.columns(), cells = rows * columns, numbers = plan.numbers();
  const cv::Rect2f whole(0, 0, 1, 1);
  std::vector<ScoredBox> boxes;
  std::vector<float> one(numbers);
  for (std::int64_t a = 0; a < static_cast<std::int64_t>(plan.anchors.size()); ++a) {
    for (std::int64_t i = 0; i < cells; ++i) {
      for (std::int64_t k = 0; k < numbers; ++k) one[k] = output[(a * numbers + k) * cells + i];
      const float object = logistic(one[4]);
      if (!(object >= score)) continue;
      const float largest = *std::max_element(one.begin() + 5, one.end());
      float sum = 0.0f;
      for (std::int64_t k = 5; k < numbers; ++k) sum += one[k] = std::exp(one[k] - largest);
      const cv::Rect2f box = region_box(one.data(), plan, a, i / columns, i % columns) & whole;
      const auto best = std::max_element(one.begin() + 5, one.end());
      if (object * *best / sum >= score && !box.empty())
        boxes.push_back({static_cast<int>(best - one.begin()) - 5, box, object * *best / sum});
    }
  }
  std::stable_sort(boxes.begin(), boxes.end(), [](const ScoredBox& a, const ScoredBox& b) { return a.score > b.score; });
  std::vector<ScoredBox> kept;
  for (const ScoredBox& box : boxes) {
    const bool covered = std::any_of(kept.begin(), kept.end(), [&](const ScoredBox& better) {
      return better.class_index == box.class_index && box_iou(better.share, box.share) > nms_iou;
    });
    if (!covered) kept.push_back(box);
  }
  return kept;
}

}  // namespace waretwin::train
