#include "harness/score/threshold_score.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace waretwin {

namespace {

constexpr int kNothing = -1;

std::optional<double> ratio(int part, int rest) {
  if (part + rest == 0) return std::nullopt;
  return static_cast<double>(part) / (part + rest);
}

// The index of the true box that a detection overlaps most among those that `may` allows, at least `least`; the number of boxes if none.
template <class May>
std::size_t best_partner(const ScoredBox& detection, const std::vector<TrueBox>& truth, double least, May&& may) {
  double best = least;
  std::size_t partner = truth.size();
  for (std::size_t g = 0; g < truth.size(); ++g) {
    if (!may(g)) continue;
    const double iou = overlap(detection.box, truth[g]);
    if (iou < best || iou <= 0.0) continue;
    best = iou;
    partner = g;
  }
  return partner;
}

}  // namespace

std::optional<double> ThresholdFigures::precision() const { return ratio(right, wrong); }
std::optional<double> ThresholdFigures::recall() const { return ratio(right, missed); }

ThresholdScore score_at_threshold(const std::vector<ScoredPicture>& pictures, int classes, const ThresholdRules& rules) {
  ThresholdScore score;
  score.classes.resize(static_cast<std::size_t>(classes));
  std::map<std::pair<int, int>, int> confusions;  // (truth, detected)
  for (const ScoredPicture& picture : pictures) {
    const std::vector<TrueBox>& truth = picture.truth;
    std::vector<const ScoredBox*> detections, left;
    for (const ScoredBox& detection : picture.detections) {
      if (detection.score >= rules.confidence) detections.push_back(&detection);
    }
    std::stable_sort(detections.begin(), detections.end(), [](const auto* a, const auto* b) { return a->score > b->score; });
    std::vector<bool> taken(truth.size(), false);
    for (const ScoredBox* detection : detections) {
      const auto same_class = [&](std::size_t g) { return truth[g].class_index == detection->class_index; };
      const std::size_t partner =
          best_partner(*detection, truth, rules.match_iou, [&](std::size_t g) { return same_class(g) && !truth[g].ignored && !taken[g]; });
      if (partner < truth.size()) {
        taken[partner] = true;
        ++score.classes[static_cast<std::size_t>(detection->class_index)].right;
        continue;
      }
      const std::size_t crowd =
          best_partner(*detection, truth, rules.match_iou, [&](std::size_t g) { return same_class(g) && truth[g].ignored; });
      if (crowd == truth.size()) left.push_back(detection);
    }
    for (const ScoredBox* detection : left) {
      ++score.classes[static_cast<std::size_t>(detection->class_index)].wrong;
      const std::size_t partner =
          best_partner(*detection, truth, rules.match_iou, [&](std::size_t g) { return !truth[g].ignored && !taken[g]; });
      if (partner == truth.size()) {
        ++confusions[{kNothing, detection->class_index}];
        continue;
      }
      taken[partner] = true;
      ++score.classes[static_cast<std::size_t>(truth[partner].class_index)].missed;
      ++confusions[{truth[partner].class_index, detection->class_index}];
    }
    for (std::size_t g = 0; g < truth.size(); ++g) {
      if (taken[g] || truth[g].ignored) continue;
      ++score.classes[static_cast<std::size_t>(truth[g].class_index)].missed;
      ++confusions[{truth[g].class_index, kNothing}];
    }
  }

  double precision_sum = 0.0;
  int with_objects = 0;
  for (const ThresholdFigures& figures : score.classes) {
    score.all.right += figures.right;
    score.all.wrong += figures.wrong;
    score.all.missed += figures.missed;
    if (figures.right + figures.missed == 0) continue;
    precision_sum += figures.precision().value_or(0.0);
    ++with_objects;
  }
  if (with_objects > 0) score.map_paper = precision_sum / with_objects;
  const auto class_or_none = [](int index) { return index == kNothing ? std::nullopt : std::optional<int>(index); };
  for (const auto& [pair, count] : confusions) score.confusions.push_back({class_or_none(pair.first), class_or_none(pair.second), count});
  const auto last_if_none = [&](const std::optional<int>& index) { return index.value_or(classes); };
  std::sort(score.confusions.begin(), score.confusions.end(), [&](const Confusion& a, const Confusion& b) {
    return std::tuple(-a.count, last_if_none(a.truth), last_if_none(a.detected)) <
           std::tuple(-b.count, last_if_none(b.truth), last_if_none(b.detected));
  });
  return score;
}

}  // namespace waretwin
