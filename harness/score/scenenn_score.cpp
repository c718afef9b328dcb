#include "harness/score/scenenn_score.h"

#include <map>

#include "core/statistics.h"

namespace waretwin {

namespace {

std::optional<double> mean_or_none(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional(mean(values));
}

SequenceScore score_sequence(const MappedSequence& sequence, const ScoringRules& rules) {
  ObjectListScore objects = score_objects(sequence.mapped, sequence.truth, rules);
  SequenceScore score;
  score.name = sequence.name;
  score.times = sequence.times;
  std::vector<double> ious, found;
  for (const ClassScore& one : objects.classes) {
    if (!one.mean_iou3d) continue;
    ious.push_back(*one.mean_iou3d);
    if (*one.mean_iou3d > 0.0) found.push_back(*one.mean_iou3d);
  }
  score.classes = std::move(objects.classes);
  score.mean_iou3d = mean_or_none(ious);
  score.mean_iou3d_found = mean_or_none(found);
  score.map_paper = objects.summary.map_paper;
  score.ap50 = objects.summary.ap50;
  return score;
}

}  // namespace

SceneNnScore score_sequences(const std::vector<MappedSequence>& sequences, const ScoringRules& rules) {
  SceneNnScore score;
  score.rules = rules;
  struct Values {
    std::vector<double> ious, precisions, areas;
  };
  std::map<std::string, Values> by_class;
  Values all;
  std::vector<StageTimes> times;
  for (const MappedSequence& sequence : sequences) {
    const SequenceScore& one = score.sequences.emplace_back(score_sequence(sequence, rules));
    if (one.times) times.push_back(*one.times);
    for (const ClassScore& c : one.classes) {
      if (!c.mean_iou3d) continue;
      Values& values = by_class[c.class_name];
      values.ious.push_back(*c.mean_iou3d);
      values.precisions.push_back(*c.ap_paper);
      values.areas.push_back(*c.ap50);
    }
    if (!one.mean_iou3d) continue;
    all.ious.push_back(*one.mean_iou3d);
    all.precisions.push_back(*one.map_paper);
    all.areas.push_back(*one.ap50);
  }
  for (const auto& [name, values] : by_class) {
    score.classes.push_back({name, static_cast<int>(values.ious.size()), mean(values.ious), mean(values.precisions), mean(values.areas)});
  }
  score.mean_iou3d = mean_or_none(all.ious);
  score.map_paper = mean_or_none(all.precisions);
  score.ap50 = mean_or_none(all.areas);
  score.times = mean_times(times);
  return score;
}

}  // namespace waretwin
