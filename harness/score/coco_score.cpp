#include "harness/score/coco_score.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

constexpr std::size_t kThresholds = 10;  // of IoU
constexpr std::size_t kRecalls = 101;

struct Areas {
  double least, most;  // both ends belong to it
};
constexpr std::array<Areas, 4> kAreas = {{{0.0, 1e10}, {0.0, 32.0 * 32.0}, {32.0 * 32.0, 96.0 * 96.0}, {96.0 * 96.0, 1e10}}};
enum AreaIndex { kAll = 0, kSmall = 1, kMedium = 2, kLarge = 3 };

// The official thresholds come from numpy's linspace; the last bits decide for IoU and recall that are round numbers.
std::array<double, kThresholds> iou_thresholds() {
  std::array<double, kThresholds> values{};
  const double step = (0.95 - 0.5) / 9.0;
  for (std::size_t i = 0; i < kThresholds; ++i) values[i] = static_cast<double>(i) * step + 0.5;
  values.back() = 0.95;
  return values;
}

// One detection after matching, at one range of areas.
struct Ranked {
  double score = 0.0;
  std::size_t rank = 0;        // among those of its class in its picture
  std::uint16_t matched = 0;   // a bit an IoU threshold
  std::uint16_t left_out = 0;  // neither right nor wrong
};

// What one class has in one picture.
struct Candidates {
  std::vector<const TrueBox*> truth;
  std::vector<const ScoredBox*> detections;  // best first, no more than count
  std::vector<double> overlaps;              // detection by truth
};

// Greedy, best detection first, each taking the free true box it overlaps most; ignored ones only where no other is left.
void match(const Candidates& c, const Areas& areas, std::vector<Ranked>& ranked, int& to_find) {
  const auto outside = [&](double area) { return area < areas.least || area > areas.most; };
  std::vector<std::size_t> order(c.truth.size());
  std::vector<bool> ignored(c.truth.size());
  for (std::size_t g = 0; g < c.truth.size(); ++g) {
    order[g] = g;
    ignored[g] = c.truth[g]->ignored || outside(c.truth[g]->size());
    to_find += ignored[g] ? 0 : 1;
  }
  std::stable_partition(order.begin(), order.end(), [&](std::size_t g) { return !ignored[g]; });
  const std::size_t first = ranked.size();
  for (std::size_t d = 0; d < c.detections.size(); ++d) ranked.push_back({c.detections[d]->score, d, 0, 0});
  const std::array<double, kThresholds> thresholds = iou_thresholds();
  std::vector<bool> taken(c.truth.size());
  for (std::size_t t = 0; t < kThresholds; ++t) {
    const auto bit = static_cast<std::uint16_t>(1u << t);
    taken.assign(c.truth.size(), false);
    for (std::size_t d = 0; d < c.detections.size(); ++d) {
      double best = thresholds[t];
      std::size_t partner = c.truth.size();
      for (const std::size_t g : order) {
        if (taken[g] && !c.truth[g]->ignored) continue;  // a crowd holds many
        if (partner < c.truth.size() && !ignored[partner] && ignored[g]) break;
        const double iou = c.overlaps[d * c.truth.size() + g];
        if (iou < best) continue;
        best = iou;
        partner = g;
      }
      Ranked& detection = ranked[first + d];
      if (partner < c.truth.size()) {
        taken[partner] = true;
        detection.matched |= bit;
        if (ignored[partner]) detection.left_out |= bit;
      } else if (outside(c.detections[d]->box.area())) {
        detection.left_out |= bit;
      }
    }
  }
}

// Precision averaged over the recall thresholds, and the recall reached, at one IoU threshold.
struct Curve {
  double precision = 0.0, recall = 0.0;
};

Curve curve_of(const std::vector<Ranked>& ranked, std::size_t threshold, std::size_t most, int to_find) {
  const auto bit = static_cast<std::uint16_t>(1u << threshold);
  std::vector<double> recalls, precisions;
  int right = 0, wrong = 0;
  for (const Ranked& detection : ranked) {
    if (detection.rank >= most) continue;
    if ((detection.left_out & bit) == 0) ++((detection.matched & bit) != 0 ? right : wrong);
    recalls.push_back(static_cast<double>(right) / to_find);
    precisions.push_back(right + wrong > 0 ? static_cast<double>(right) / (right + wrong) : 0.0);
  }
  for (std::size_t i = precisions.size(); i-- > 1;) precisions[i - 1] = std::max(precisions[i - 1], precisions[i]);
  double sum = 0.0;
  for (std::size_t r = 0; r < kRecalls; ++r) {
    const double recall = r + 1 == kRecalls ? 1.0 : static_cast<double>(r) * 0.01;
    const auto reached = std::lower_bound(recalls.begin(), recalls.end(), recall);
    if (reached != recalls.end()) sum += precisions[static_cast<std::size_t>(reached - recalls.begin())];
  }
  return {sum / kRecalls, recalls.empty() ? 0.0 : recalls.back()};
}

struct Averages {
  double ap = 0.0, ap50 = 0.0, ap75 = 0.0, ar = 0.0;
};

Averages averages_of(const std::vector<Ranked>& ranked, std::size_t most, int to_find) {
  Averages averages;
  for (std::size_t t = 0; t < kThresholds; ++t) {
    const Curve curve = curve_of(ranked, t, most, to_find);
    averages.ap += curve.precision / kThresholds;
    averages.ar += curve.recall / kThresholds;
    if (t == 0) averages.ap50 = curve.precision;
    if (t == 5) averages.ap75 = curve.precision;
  }
  return averages;
}

std::vector<Candidates> candidates_of(const std::vector<ScoredPicture>& pictures, int class_index) {
  std::vector<Candidates> all;
  for (const ScoredPicture& picture : pictures) {
    Candidates c;
    for (const TrueBox& truth : picture.truth) {
      if (truth.class_index == class_index) c.truth.push_back(&truth);
    }
    for (const ScoredBox& detection : picture.detections) {
      if (detection.class_index == class_index) c.detections.push_back(&detection);
    }
    if (c.truth.empty() && c.detections.empty()) continue;
    std::stable_sort(c.detections.begin(), c.detections.end(), [](const auto* a, const auto* b) { return a->score > b->score; });
    if (c.detections.size() > kMostDetections) c.detections.resize(kMostDetections);
    for (const ScoredBox* detection : c.detections) {
      for (const TrueBox* truth : c.truth) c.overlaps.push_back(overlap(detection->box, *truth));
    }
    all.push_back(std::move(c));
  }
  return all;
}

CocoFigures score_class(const std::vector<ScoredPicture>& pictures, int class_index) {
  const std::vector<Candidates> all = candidates_of(pictures, class_index);
  CocoFigures figures;
  for (std::size_t a = 0; a < kAreas.size(); ++a) {
    std::vector<Ranked> ranked;
    int to_find = 0;
    for (const Candidates& c : all) match(c, kAreas[a], ranked, to_find);
    if (to_find == 0) continue;
    std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& x, const Ranked& y) { return x.score > y.score; });
    const Averages averages = averages_of(ranked, kMostDetections, to_find);
    switch (a) {
      case kSmall:
        figures.ap_small = averages.ap;
        figures.ar_small = averages.ar;
        break;
      case kMedium:
        figures.ap_medium = averages.ap;
        figures.ar_medium = averages.ar;
        break;
      case kLarge:
        figures.ap_large = averages.ap;
        figures.ar_large = averages.ar;
        break;
      default:
        figures.ap = averages.ap;
        figures.ap50 = averages.ap50;
        figures.ap75 = averages.ap75;
        figures.ar100 = averages.ar;
        figures.ar1 = averages_of(ranked, 1, to_find).ar;
        figures.ar10 = averages_of(ranked, 10, to_find).ar;
    }
  }
  return figures;
}

}  // namespace

CocoScore score_coco(const std::vector<ScoredPicture>& pictures, int classes) {
  CocoScore score;
  score.classes.resize(static_cast<std::size_t>(classes));
  parallel_for(score.classes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) score.classes[k] = score_class(pictures, static_cast<int>(k));
  });
  for (const auto figure : {&CocoFigures::ap, &CocoFigures::ap50, &CocoFigures::ap75, &CocoFigures::ap_small, &CocoFigures::ap_medium,
                            &CocoFigures::ap_large, &CocoFigures::ar1, &CocoFigures::ar10, &CocoFigures::ar100, &CocoFigures::ar_small,
                            &CocoFigures::ar_medium, &CocoFigures::ar_large}) {
    double sum = 0.0;
    int count = 0;
    for (const CocoFigures& figures : score.classes) {
      if (!(figures.*figure)) continue;
      sum += *(figures.*figure);
      ++count;
    }
    if (count > 0) score.all.*figure = sum / count;
  }
  return score;
}

}  // namespace waretwin
