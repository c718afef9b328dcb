// What one step of training sees.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace waretwin::train {

struct TruthBox {
  int class_index = 0;
  cv::Rect2f share;      // left, top, width, height as shares of the picture
  bool ignored = false;  // neither to be found nor a mistake if found
};

struct Sample {
  cv::Mat picture;  // CV_8UC3, RGB, of the network's input size
  std::vector<TruthBox> boxes;
};

inline float box_iou(const cv::Rect2f& a, const cv::Rect2f& b) {
  const float common = (a & b).area();
  return common > 0.0f ? common / (a.area() + b.area() - common) : 0.0f;
}

}  // namespace waretwin::train
