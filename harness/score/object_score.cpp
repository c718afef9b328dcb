#include "harness/score/object_score.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "core/pose.h"
#include "core/statistics.h"
#include "harness/score/assignment.h"

namespace waretwin {

namespace {

std::optional<double> mean_or_none(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return mean(values);
}

std::optional<double> ratio(int part, int whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / whole;
}

double yaw_error_deg(const Cuboid& mapped, const Cuboid& truth, const ScoringRules& rules) {
  const bool square = truth.size.x() < rules.square_ratio * truth.size.y();
  return to_degrees(angle_distance(mapped.yaw, truth.yaw, square ? std::numbers::pi / 2.0 : std::numbers::pi));
}

// Indices of the objects of one class.
std::vector<std::size_t> of_class(const std::vector<ListedObject>& objects, const std::string& class_name) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].class_name == class_name) indices.push_back(i);
  }
  return indices;
}

struct RankedObject {
  double score = 0.0;
  bool hit = false;
};

// Area under the curve of the highest precision reached at each recall or beyond. Objects of equal score enter together, so that their
// order in the list has no say.
double average_precision(std::vector<RankedObject> ranked, int truth_count) {
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedObject& a, const RankedObject& b) { return a.score > b.score; });
  struct CurvePoint {
    double recall, precision;
  };
  std::vector<CurvePoint> curve;
  int hits = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    hits += ranked[i].hit ? 1 : 0;
    if (i + 1 < ranked.size() && ranked[i + 1].score == ranked[i].score) continue;
    curve.push_back({static_cast<double>(hits) / truth_count, hits / static_cast<double>(i + 1)});
  }
  double area = 0.0, best_precision = 0.0;
  for (std::size_t i = curve.size(); i-- > 0;) {
    best_precision = std::max(best_precision, curve[i].precision);
    const double before = i == 0 ? 0.0 : curve[i - 1].recall;
    area += (curve[i].recall - before) * best_precision;
  }
  return area;
}

}  // namespace

void ScoringRules::visit(Fields& f) {
  f("max_centre_distance_m", max_centre_distance_m, "the centres of a pair are nearer than this", {.min = 0, .max = 1000});
  f("match_iou", match_iou, "a pair is matched from this 3D IoU on", {.min = 0, .max = 1});
  f("min_visible_fraction", min_visible_fraction, "true objects of which less was seen do not count", {.min = 0, .max = 1});
  f("square_ratio", square_ratio, "below this dx / dy a box looks the same after 90 deg", {.min = 1, .max = 10});
}

ObjectListScore score_objects(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth, const ScoringRules& rules) {
  ObjectListScore result;
  result.objects.resize(truth.size());
  std::set<std::string> classes;
  for (std::size_t t = 0; t < truth.size(); ++t) {
    ObjectScore& row = result.objects[t];
    row.truth_id = truth[t].id;
    row.class_name = truth[t].class_name;
    row.visible_fraction = truth[t].visible_fraction;
    row.counted = truth[t].visible_fraction >= rules.min_visible_fraction;
    classes.insert(truth[t].class_name);
  }

  ScoreSummary& summary = result.summary;
  std::vector<double> ious, translations, rotations, class_ap, class_precision;
  for (const std::string& class_name : classes) {
    const std::vector<std::size_t> truths = of_class(truth, class_name);
    const std::vector<std::size_t> candidates = of_class(mapped, class_name);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(truths.size()), static_cast<Eigen::Index>(candidates.size()));
    for (std::size_t i = 0; i < truths.size(); ++i) {
      for (std::size_t j = 0; j < candidates.size(); ++j) {
        const Cuboid& a = truth[truths[i]].cuboid;
        const Cuboid& b = mapped[candidates[j]].cuboid;
        const double iou = iou_3d(a, b);
        const bool near = (a.centre - b.centre).norm() < rules.max_centre_distance_m;
        if (near) weights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = iou;
      }
    }
    const std::vector<int> partner = assign_largest(weights);

    ClassScore score;
    score.class_name = class_name;
    std::vector<double> class_ious;
    std::vector<RankedObject> ranked(candidates.size());
    std::vector<bool> ignored(candidates.size(), false);
    for (std::size_t j = 0; j < candidates.size(); ++j) ranked[j].score = mapped[candidates[j]].score;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      ObjectScore& row = result.objects[truths[i]];
      if (partner[i] >= 0) {
        const auto j = static_cast<std::size_t>(partner[i]);
        const ListedObject& match = mapped[candidates[j]];
        const Cuboid& true_cuboid = truth[truths[i]].cuboid;
        row.map_id = match.id;
        row.iou3d = weights(static_cast<Eigen::Index>(i), partner[i]);
        row.e_trans_m = (match.cuboid.centre - true_cuboid.centre).norm();
        row.e_rot_deg = yaw_error_deg(match.cuboid, true_cuboid, rules);
        if (row.counted) {
          translations.push_back(*row.e_trans_m);
          rotations.push_back(*row.e_rot_deg);
          ranked[j].hit = row.iou3d >= rules.match_iou;
          score.matched += ranked[j].hit ? 1 : 0;
          ++score.assigned;
        } else {
          ignored[j] = true;
        }
      }
      if (row.counted) {
        ious.push_back(row.iou3d);
        class_ious.push_back(row.iou3d);
        ++score.truth;
      }
    }

    std::vector<RankedObject> counted;
    for (std::size_t j = 0; j < ranked.size(); ++j) {
      if (ignored[j]) continue;
      counted.push_back(ranked[j]);
      if (!ranked[j].hit) result.false_positives.push_back(mapped[candidates[j]].id);
    }
    score.mapped = static_cast<int>(counted.size());
    if (score.truth > 0) {
      score.mean_iou3d = mean(class_ious);
      score.ap50 = average_precision(counted, score.truth);
      score.ap_paper = ratio(score.matched, score.mapped).value_or(0.0);
      class_ap.push_back(*score.ap50);
      class_precision.push_back(*score.ap_paper);
    }
    summary.truth += score.truth;
    summary.mapped += score.mapped;
    summary.matched += score.matched;
    result.classes.push_back(std::move(score));
  }
  std::sort(result.false_positives.begin(), result.false_positives.end());
  summary.recall = ratio(summary.matched, summary.truth);
  summary.precision = ratio(summary.matched, summary.mapped);
  summary.mean_iou3d = mean_or_none(ious);
  summary.mean_e_trans_m = mean_or_none(translations);
  summary.mean_e_rot_deg = mean_or_none(rotations);
  summary.ap50 = mean_or_none(class_ap);
  summary.map_paper = mean_or_none(class_precision);
  return result;
}

}  // namespace waretwin
