// What the detector found in the mapped frames of a run, beside what was there: detections.jsonl and score.json's `detection`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/fields.h"
#include "harness/score/detection_score.h"
#include "harness/truth/label_rule.h"
#include "mapper/mapper.h"
#include "scenes/scene.h"
#include "sim/object_views.h"

namespace waretwin {

struct DetectionLogConfig {
  LabelRule labels;        // what is to be found; other visible objects are neither mistakes nor to be found
  double match_iou = 0.5;  // a box is found from this overlap on
  void visit(Fields& f);
};

class DetectionLog {
 public:
  DetectionLog(const Scene& scene, const DetectionLogConfig& config);

  // A mapped frame, with what its picture shows of each object.
  void add(const RgbdFrame& frame, const std::vector<Detection>& detections, const std::vector<ObjectView>& views);

  // A line of JSON a frame: stamp_ns, sensor; detections (class, box, score); truth (id, class, box, visible; ignored where it need not be
  // found). Boxes are x, y, width, height in pixels.
  const std::string& lines() const { return lines_; }
  // Nothing without frames, or without objects in the hall. Detections of classes that the hall has none of are counted and in no figure.
  // All detections count, whatever their score: the mapper has taken them.
  std::optional<DetectionScore> score() const;

 private:
  std::optional<int> class_index(const std::string& name) const;

  DetectionLogConfig config_;
  std::map<int, std::string> class_of_object_;
  std::vector<std::string> classes_;
  std::vector<ScoredPicture> pictures_;
  int other_detections_ = 0;
  std::string lines_;
};

}  // namespace waretwin
