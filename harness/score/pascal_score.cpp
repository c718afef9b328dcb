#include "harness/score/pascal_score.h"

#include <algorithm>

namespace waretwin {

namespace {

constexpr double kMinimumOverlap = 0.5;

struct Ranked {
  double score = 0.0;
  bool right = false;
};

// What each detection of the class is, best first; those that stand for an ignored box are left out.
std::vector<Ranked> ranked_detections(const std::vector<ScoredPicture>& pictures, int class_index, int& to_find) {
  std::vector<Ranked> ranked;
  for (const ScoredPicture& picture : pictures) {
    std::vector<const ScoredBox*> detections;
    for (const ScoredBox& detection : picture.detections) {
      if (detection.class_index == class_index) detections.push_back(&detection);
    }
    std::stable_sort(detections.begin(), detections.end(), [](const auto* a, const auto* b) { return a->score > b->score; });
    for (const TrueBox& truth : picture.truth) to_find += truth.class_index == class_index && !truth.ignored ? 1 : 0;
    std::vector<bool> found(picture.truth.size(), false);
    for (const ScoredBox* detection : detections) {
      double best = 0.0;
      std::size_t partner = picture.truth.size();
      for (std::size_t g = 0; g < picture.truth.size(); ++g) {
        if (picture.truth[g].class_index != class_index) continue;
        const double iou = overlap(detection->box, picture.truth[g]);
        if (iou <= best) continue;
        best = iou;
        partner = g;
      }
      const bool near = best >= kMinimumOverlap;
      if (near && picture.truth[partner].ignored) continue;
      ranked.push_back({detection->score, near && !found[partner]});
      if (near) found[partner] = true;
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
  return ranked;
}

PascalFigures figures_of(const std::vector<Ranked>& ranked, int to_find) {
  if (to_find == 0) return {};
  std::vector<int> right;
  std::vector<double> precision;
  for (const Ranked& detection : ranked) {
    right.push_back((right.empty() ? 0 : right.back()) + (detection.right ? 1 : 0));
    precision.push_back(static_cast<double>(right.back()) / static_cast<double>(right.size()));
  }
  for (std::size_t i = precision.size(); i-- > 1;) precision[i - 1] = std::max(precision[i - 1], precision[i]);
  double eleven = 0.0, area = 0.0;
  for (int tenth = 0; tenth <= 10; ++tenth) {
    // In whole numbers: 0.3 of ten objects is three of them.
    const auto reached = std::find_if(right.begin(), right.end(), [&](int hits) { return 10 * hits >= tenth * to_find; });
    if (reached != right.end()) eleven += precision[static_cast<std::size_t>(reached - right.begin())];
  }
  for (std::size_t i = 0; i < right.size(); ++i) area += (right[i] - (i == 0 ? 0 : right[i - 1])) * precision[i] / to_find;
  return {eleven / 11.0, area};
}

}  // namespace

PascalScore score_pascal(const std::vector<ScoredPicture>& pictures, int classes) {
  PascalScore score;
  double eleven = 0.0, every = 0.0;
  int count = 0;
  for (int k = 0; k < classes; ++k) {
    int to_find = 0;
    const std::vector<Ranked> ranked = ranked_detections(pictures, k, to_find);
    score.classes.push_back(figures_of(ranked, to_find));
    if (to_find == 0) continue;
    eleven += *score.classes.back().eleven_point;
    every += *score.classes.back().every_point;
    ++count;
  }
  if (count > 0) score.all = {eleven / count, every / count};
  return score;
}

}  // namespace waretwin
