// A detector over many pictures: what it finds as a file and drawn, and how good it is where the pictures are labelled.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "harness/labelled/labelled_set.h"
#include "harness/score/detection_score.h"
#include "mapper/detect/detect_config.h"

namespace waretwin {

struct DetectScoring {
  double ap_confidence = 0.001;
  double match_iou = 0.5;

  void visit(Fields& f) {
    f("ap_confidence", ap_confidence, "labelled sets: detections from this score on count for AP and AR", {.min = 0, .max = 1});
    f("match_iou", match_iou, "labelled sets: overlap from which an object is found, for precision, recall and what is wrong",
      {.min = 0, .max = 1});
  }
};

struct DetectRunConfig {
  DetectConfig detect;
  DetectScoring score;
  bool pictures = true;  // drawn

  void visit(Fields& f) {
    f.group("detect", detect, "the detector's network");
    f.group("score", score, "how detections are held against labels");
  }
};

struct DetectRunResult {
  int pictures = 0;
  std::map<std::string, int> detections;  // by class, from detect.confidence on
  double median_ms = 0.0;                 // of detection, a picture
  std::optional<DetectionScore> score;    // of a labelled set
};

using DetectProgress = std::function<void(double done, int pictures, int detections)>;

// Writes detections.json and pictures/ into `out` as it goes and puts them in place at the end; an exception leaves those of an earlier
// run. `set` without classes is not labelled. With detect.classes, the labels of other classes are left out. One picture at a time is
// held, and of the rest only numbers. Throws Error where a picture, the model or a setting cannot be used, and where model and set have no
// class in common.
DetectRunResult detect_pictures(const std::filesystem::path& model, const LabelledSet& set, const DetectRunConfig& config,
                                const std::filesystem::path& out, const DetectProgress& progress);

}  // namespace waretwin
