#include "harness/score/detection_score.h"

#include "core/error.h"

namespace waretwin {

int DetectionScore::label_count() const {
  int count = 0;
  for (const int labels_of_class : labels) count += labels_of_class;
  return count;
}

DetectionScore score_detections(const std::vector<ScoredPicture>& pictures, const std::vector<std::string>& classes,
                                const ThresholdRules& rules) {
  DetectionScore score;
  score.classes = classes;
  score.labels.resize(classes.size());
  score.images = static_cast<int>(pictures.size());
  score.rules = rules;
  const int count = static_cast<int>(classes.size());
  for (const ScoredPicture& picture : pictures) {
    for (const TrueBox& truth : picture.truth) {
      WARETWIN_CHECK(truth.class_index >= 0 && truth.class_index < count, "true boxes have a class");
      if (truth.ignored)
        ++score.ignored_labels;
      else
        ++score.labels[static_cast<std::size_t>(truth.class_index)];
    }
    for (const ScoredBox& detection : picture.detections) {
      WARETWIN_CHECK(detection.class_index >= 0 && detection.class_index < count, "detections have a class");
    }
  }
  score.coco = score_coco(pictures, count);
  score.pascal = score_pascal(pictures, count);
  score.at_threshold = score_at_threshold(pictures, count, rules);
  return score;
}

}  // namespace waretwin
