// Average precision and recall as COCO defines them (cocodataset.org, "Detection evaluation"; Lin et al. 2014), step by step as the
// official evaluator computes them, so that figures compare with published ones.
#pragma once

#include <optional>
#include <vector>

#include "harness/score/scored_boxes.h"

namespace waretwin {

inline constexpr std::size_t kMostDetections = 100;  // of a class in a picture; weaker ones do not count

// Means over the classes that have something to be found; nothing where none has.
struct CocoFigures {
  std::optional<double> ap;    // over IoU thresholds 0.50, 0.55 .. 0.95, precision read off at recall 0, 0.01 .. 1
  std::optional<double> ap50;  // at IoU 0.50 alone
  std::optional<double> ap75;
  std::optional<double> ap_small, ap_medium, ap_large;  // true areas up to 32^2, 32^2 to 96^2, from 96^2 pixels
  std::optional<double> ar1, ar10, ar100;               // recall by the 1, 10, 100 best of a class in each picture, over the IoU thresholds
  std::optional<double> ar_small, ar_medium, ar_large;  // by 100
};

struct CocoScore {
  CocoFigures all;
  std::vector<CocoFigures> classes;  // by class index
};

// Order of the pictures matters only between equal scores.
CocoScore score_coco(const std::vector<ScoredPicture>& pictures, int classes);

}  // namespace waretwin
