// 2D boxes as detection metrics see them: what is in a picture, and what a detector says is in it.
#pragma once

#include <algorithm>
#include <opencv2/core/types.hpp>
#include <vector>

namespace waretwin {

struct TrueBox {
  int class_index = 0;
  cv::Rect2d box;        // pixels
  double area = 0.0;     // square pixels, by which COCO calls it small, medium or large; 0: that of the box
  bool ignored = false;  // a crowd: not to be found, and detections of its class inside it are no mistakes
  double size() const { return area > 0.0 ? area : box.area(); }
};

struct ScoredBox {
  int class_index = 0;
  cv::Rect2d box;  // pixels
  double score = 0.0;
};

struct ScoredPicture {
  std::vector<TrueBox> truth;
  std::vector<ScoredBox> detections;  // in any order; of equal scores the earlier one comes first
};

// Intersection over union in [0, 1]; 0 where both are empty. With an ignored region it is the share of the detection that lies inside, as
// a crowd is larger than any one of its members.
inline double overlap(const cv::Rect2d& detection, const TrueBox& truth) {
  const double width = std::min(detection.x + detection.width, truth.box.x + truth.box.width) - std::max(detection.x, truth.box.x);
  const double height = std::min(detection.y + detection.height, truth.box.y + truth.box.height) - std::max(detection.y, truth.box.y);
  if (width <= 0.0 || height <= 0.0) return 0.0;
  const double both = width * height;
  const double whole = truth.ignored ? detection.area() : detection.area() + truth.box.area() - both;
  return whole > 0.0 ? both / whole : 0.0;
}

}  // namespace waretwin
