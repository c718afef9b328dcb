// A labelled set against what a detector finds, picture by picture: classes matched by name, shares turned into pixels.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/labelled/labelled_set.h"
#include "harness/score/detection_score.h"
#include "mapper/detect/detector.h"

namespace waretwin {

class SetScorer {
 public:
  // `wanted` classes count, or all where it is empty. Throws Error where the model has none of the set's classes.
  SetScorer(const std::vector<std::string>& set_classes, const std::vector<std::string>& model_classes,
            const std::vector<std::string>& wanted);

  // The labels that count, in pixels of the picture.
  std::vector<TrueBox> truth_of(const LabelledImage& image, const cv::Size& size) const;
  // `detections` come best first; of a class the best kMostDetections are kept, since a low threshold lets hundreds pass. Those of classes
  // that the set does not name are left out.
  void add(std::vector<TrueBox> truth, const std::vector<Detection>& detections);
  bool names(const std::string& class_name) const { return numbers_.count(class_name) != 0; }
  DetectionScore score(const ThresholdRules& rules) const { return score_detections(pictures_, classes_, rules); }

 private:
  std::vector<std::string> classes_;
  std::map<std::string, int> numbers_;  // by name
  std::vector<bool> counted_;           // by number
  std::vector<ScoredPicture> pictures_;
};

}  // namespace waretwin
