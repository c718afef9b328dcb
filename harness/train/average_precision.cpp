#include "harness/train/average_precision.h"

#include <algorithm>
#include <cmath>

namespace waretwin::train {
namespace {

struct Judged {
  float score = 0.0f;
  bool correct = false;
};

// The free object that the box overlaps most, if by `iou`; nothing otherwise.
const TruthBox* best_free(const ScoredBox& box, const std::vector<TruthBox>& truth, const std::vector<bool>& taken, float iou) {
  const TruthBox* best = nullptr;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (taken[i] || truth[i].ignored || truth[i].class_index != box.class_index) continue;
    const float overlap = box_iou(box.share, truth[i].share);
    if (overlap >= iou) {
      iou = overlap;
      best = &truth[i];
    }
  }
  return best;
}

// All detections of one class, best first, and how many objects there are.
struct Judgement {
  std::vector<Judged> detections;
  double objects = 0.0;
};

Judgement judge(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, int class_index,
                float iou) {
  Judgement out;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    for (const TruthBox& box : truth[n]) out.objects += !box.ignored && box.class_index == class_index ? 1.0 : 0.0;
    std::vector<bool> taken(truth[n].size());
    for (const ScoredBox& box : found[n]) {
      if (box.class_index != class_index) continue;
      const TruthBox* const object = best_free(box, truth[n], taken, iou);
      const bool excused =
          object == nullptr && std::any_of(truth[n].begin(), truth[n].end(), [&](const TruthBox& other) {
            // As harness/score/scored_boxes.h has it: how much of the detection lies inside.
            return other.ignored && other.class_index == class_index && (box.share & other.share).area() >= iou * box.share.area();
          });
      if (object != nullptr) taken[static_cast<std::size_t>(object - truth[n].data())] = true;
      if (!excused) out.detections.push_back({box.score, object != nullptr});
    }
  }
  std::stable_sort(out.detections.begin(), out.detections.end(), [](const Judged& a, const Judged& b) { return a.score > b.score; });
  return out;
}

double area_under(const Judgement& judgement) {
  std::vector<double> precision, recall;
  double correct = 0.0;
  for (const Judged& one : judgement.detections) {
    correct += one.correct ? 1.0 : 0.0;
    precision.push_back(correct / static_cast<double>(precision.size() + 1));
    recall.push_back(correct / judgement.objects);
  }
  double area = 0.0, best = 0.0;
  for (std::size_t i = precision.size(); i-- > 0;) {
    best = std::max(best, precision[i]);
    area += best * (recall[i] - (i > 0 ? recall[i - 1] : 0.0));
  }
  return area;
}

}  // namespace

double average_precision(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, int classes,
                         float iou) {
  double sum = 0.0;
  int counted = 0;
  for (int c = 0; c < classes; ++c) {
    const Judgement judgement = judge(found, truth, c, iou);
    if (judgement.objects == 0.0) continue;
    sum += area_under(judgement);
    ++counted;
  }
  return counted > 0 ? sum / counted : 0.0;
}

double balanced_score(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, int classes,
                      float iou) {
  std::vector<Judged> all;
  double objects = 0.0;
  for (int c = 0; c < classes; ++c) {
    const Judgement judgement = judge(found, truth, c, iou);
    all.insert(all.end(), judgement.detections.begin(), judgement.detections.end());
    objects += judgement.objects;
  }
  std::stable_sort(all.begin(), all.end(), [](const Judged& a, const Judged& b) { return a.score > b.score; });
  std::vector<double> balance;  // F1 with all detections up to this one
  double correct = 0.0;
  for (const Judged& one : all) {
    correct += one.correct ? 1.0 : 0.0;
    balance.push_back(2.0 * correct / (static_cast<double>(balance.size() + 1) + objects));
  }
  const double best = balance.empty() ? 0.0 : *std::max_element(balance.begin(), balance.end());
  if (!(best > 0.0)) return 0.5;
  constexpr double kAsGood = 0.99;
  const auto logit = [](double score) { return std::log(score / (1.0 - score)); };
  double highest = 0.0, lowest = 1.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (balance[i] < kAsGood * best) continue;
    const double score = std::clamp(static_cast<double>(all[i].score), 0.02, 0.98);
    highest = std::max(highest, score);
    lowest = std::min(lowest, score);
  }
  return 1.0 / (1.0 + std::exp(-0.5 * (logit(lowest) + logit(highest))));
}

double median_side_error(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, double width,
                         double height) {
  std::vector<double> errors;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    std::vector<bool> taken(truth[n].size());
    for (const ScoredBox& box : found[n]) {
      const TruthBox* const object = best_free(box, truth[n], taken, 0.5f);
      if (object == nullptr) continue;
      taken[static_cast<std::size_t>(object - truth[n].data())] = true;
      const cv::Point2f a = box.share.tl() - object->share.tl(), b = box.share.br() - object->share.br();
      errors.push_back(0.25 * (width * (std::abs(a.x) + std::abs(b.x)) + height * (std::abs(a.y) + std::abs(b.y))));
    }
  }
  if (errors.empty()) return 0.0;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

}  // namespace waretwin::train
