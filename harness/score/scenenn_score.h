// Maps of several sequences scored the way the paper's Tables 1 to 4 report SceneNN.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/score/object_score.h"
#include "harness/score/stage_times.h"

namespace waretwin {

struct MappedSequence {
  std::string name;
  std::vector<ListedObject> mapped, truth;
  std::optional<StageTimes> times;
};

// A class that the truth names but of which no object counts is a dash; one of which nothing was found is a zero, and counts in averages.
struct SequenceScore {
  std::string name;
  std::vector<ClassScore> classes;         // by name
  std::optional<double> mean_iou3d;        // over classes
  std::optional<double> mean_iou3d_found;  // over the classes with an IoU above 0, as the paper averages row 086 of its Table 1
  std::optional<double> map_paper;         // mean of TP / (TP + FP) over classes: the paper's mAP
  std::optional<double> ap50;              // mean of the areas under the precision-recall curves over classes
  std::optional<StageTimes> times;
};

// A class over the sequences that have it.
struct ClassMean {
  std::string class_name;
  int sequences = 0;
  double mean_iou3d = 0.0, ap_paper = 0.0, ap50 = 0.0;
};

struct SceneNnScore {
  ScoringRules rules;
  std::vector<SequenceScore> sequences;  // in the order given
  std::vector<ClassMean> classes;        // by name
  // Over the sequences that have a class that counts.
  std::optional<double> mean_iou3d, map_paper, ap50;
  std::optional<StageTimes> times;  // over the sequences that have times
};

SceneNnScore score_sequences(const std::vector<MappedSequence>& sequences, const ScoringRules& rules);

}  // namespace waretwin
