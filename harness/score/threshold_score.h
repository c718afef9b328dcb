// A detector as it is used, at one score threshold: what it finds, what it misses, and what it takes for something else.
#pragma once

#include <optional>
#include <vector>

#include "harness/score/scored_boxes.h"

namespace waretwin {

struct ThresholdRules {
  double confidence = 0.5;  // detections below this score do not count
  double match_iou = 0.5;   // a box is found from this overlap on
};

struct ThresholdFigures {
  int right = 0, wrong = 0, missed = 0;  // TP, FP, FN
  // TP / (TP + FP) and TP / (TP + FN); nothing where nothing was detected, or nothing is there.
  std::optional<double> precision() const;
  std::optional<double> recall() const;
};

// How often something was taken for something else. Classes by index; a missing `truth` is the background, a missing `detected` is an
// object that was missed.
struct Confusion {
  std::optional<int> truth, detected;
  int count = 0;
};

struct ThresholdScore {
  ThresholdFigures all;                   // over all classes
  std::vector<ThresholdFigures> classes;  // by class index
  // The paper's mAP: TP / (TP + FP) of each class that has objects, averaged; a class of which nothing was detected gives 0.
  std::optional<double> map_paper;
  std::vector<Confusion> confusions;  // most frequent first, then by class indices, the background last
};

// Within each class the best detection takes the free true box that it overlaps most, as COCO matches; what covers an ignored region of
// its class does not count. Of the rest, each detection, best first, is a confusion with the free true box of any class that it overlaps
// most, if that is `match_iou` or more.
ThresholdScore score_at_threshold(const std::vector<ScoredPicture>& pictures, int classes, const ThresholdRules& rules);

}  // namespace waretwin
