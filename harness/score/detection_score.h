// How good a detector is on labelled pictures: all published measures at once, and what it confuses.
#pragma once

#include <string>
#include <vector>

#include "harness/score/coco_score.h"
#include "harness/score/pascal_score.h"
#include "harness/score/threshold_score.h"

namespace waretwin {

struct DetectionScore {
  std::vector<std::string> classes;
  std::vector<int> labels;  // a class: boxes to be found
  int images = 0;
  int ignored_labels = 0;
  int other_detections = 0;  // of classes that the truth does not name, in no figure; set by whoever left them out
  ThresholdRules rules;
  CocoScore coco;
  PascalScore pascal;
  ThresholdScore at_threshold;
  int label_count() const;
};

// Class indices of pictures are below the number of `classes`. COCO and Pascal measures are over all detections given, the others over
// those that reach the rules' confidence.
DetectionScore score_detections(const std::vector<ScoredPicture>& pictures, const std::vector<std::string>& classes,
                                const ThresholdRules& rules);

// What metrics.json says besides the scores.
struct DetectionRunFacts {
  std::string model, dataset, split;
  double collect_confidence = 0.0;  // detections from this score on were collected for the curves
  double median_ms = 0.0;           // of detection, a picture
};

// metrics.json: docs/detection.md says what each key means.
std::string metrics_json(const DetectionScore& score, const DetectionRunFacts& facts);

// The same as a table for a terminal.
std::string metrics_table(const DetectionScore& score, const DetectionRunFacts& facts);

}  // namespace waretwin
