#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <set>

#include "harness/score/number_text.h"
#include "harness/study/chart.h"
#include "harness/study/condition.h"
#include "harness/study/study_pictures.h"

namespace waretwin {

namespace {

constexpr int kWidth = 900, kHeight = 560;
const cv::Scalar kCandidate(190, 150, 110), kFront(40, 120, 230), kBest(60, 60, 220), kBaseline(60, 160, 60), kBroken(200, 200, 200),
    kLine(150, 100, 60);

struct Range {
  double low = 1e300, high = -1e300;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

std::string axis_title(std::size_t measure) {
  return study_measures()[measure].name + (study_measures()[measure].more_is_better ? " (more is better)" : " (less is better)");
}

cv::Mat pareto_plot(const StudyConfig& study, const StudyResults& results) {
  const std::size_t mx = *study_measure(results.pareto[0]), my = *study_measure(results.pareto[1]);
  Range x, y;
  std::vector<const CandidateResult*> shown;
  for (const CandidateResult& candidate : results.candidates) {
    if (!candidate.measured[mx] || !candidate.measured[my]) continue;
    x.take(candidate.measured[mx]->mean);
    y.take(candidate.measured[my]->mean);
    shown.push_back(&candidate);
  }
  if (shown.empty()) return {};
  Chart chart(kWidth, kHeight, study.name + ": Pareto front", {axis_title(mx), x.low, x.high, {}}, {axis_title(my), y.low, y.high, {}});
  // The front last, so that nothing lies over it.
  std::stable_sort(shown.begin(), shown.end(),
                   [](const CandidateResult* a, const CandidateResult* b) { return a->on_front < b->on_front; });
  std::vector<std::pair<double, double>> front;
  for (const CandidateResult* candidate : shown) {
    const double px = candidate->measured[mx]->mean, py = candidate->measured[my]->mean;
    chart.point(px, py, !candidate->feasible() ? kBroken : candidate->on_front ? kFront : kCandidate, candidate->on_front ? 6 : 5);
    if (candidate->on_front) front.emplace_back(px, py);
  }
  // A front of two measures is a line.
  std::sort(front.begin(), front.end());
  for (std::size_t i = 1; i < front.size() && results.pareto.size() == 2; ++i)
    chart.line(front[i - 1].first, front[i - 1].second, front[i].first, front[i].second, kFront);
  const auto ring = [&](const CandidateResult& candidate, const cv::Scalar& colour, const std::string& what) {
    if (!candidate.measured[mx] || !candidate.measured[my]) return;
    const double px = candidate.measured[mx]->mean, py = candidate.measured[my]->mean;
    chart.point(px, py, colour, 9, false);
    chart.label(px, py, what, colour, 12, what == "baseline" ? 16 : -8);
  };
  ring(results.candidates.front(), kBaseline, "baseline");
  if (results.best && *results.best != 0) ring(results.candidates[*results.best], kBest, "best, " + results.candidates[*results.best].name);
  chart.legend({{"candidate", kCandidate}, {"front", kFront}, {"breaks a constraint", kBroken}});
  return chart.image();
}

// One panel a factor, all over the same axis.
cv::Mat effects_plot(const StudyResults& results, const std::string& measure) {
  std::vector<const FactorEffect*> shown;
  Range y;
  for (const FactorEffect& effect : results.effects) {
    if (effect.measure != measure || effect.levels.size() < 2) continue;
    shown.push_back(&effect);
    for (const EffectLevel& level : effect.levels) {
      // Intervals wider than the means' own range are cut off by the chart.
      y.take(level.interval.mean);
    }
  }
  if (shown.empty() || !(y.high > y.low)) return {};
  const double room = 0.2 * (y.high - y.low);
  y = {y.low - room, y.high + room};
  const int width = std::max(360, kWidth / static_cast<int>(shown.size()));
  std::vector<cv::Mat> panels;
  for (const FactorEffect* effect : shown) {
    ChartAxis x{effect->factor, 0, 0, {}};
    for (const EffectLevel& level : effect->levels) x.levels.push_back(level.level);
    Chart chart(width, 420, effect->factor, x, {axis_title(*study_measure(measure)), y.low, y.high, {}});
    for (std::size_t k = 0; k < effect->levels.size(); ++k) {
      const Interval& interval = effect->levels[k].interval;
      if (k > 0)
        chart.line(static_cast<double>(k) - 1, effect->levels[k - 1].interval.mean, static_cast<double>(k), interval.mean, kLine, 2);
      if (interval.low) chart.bar(static_cast<double>(k), *interval.low, *interval.high, kCandidate);
      chart.point(static_cast<double>(k), interval.mean, kFront, 5);
    }
    panels.push_back(chart.image());
  }
  cv::Mat all;
  cv::hconcat(panels, all);
  return all;
}

// A measure over two factors of numbers, where the candidates are a grid.
cv::Mat field_plot(const StudyConfig& study, const StudyResults& results, std::size_t measure) {
  std::map<std::pair<double, double>, const CandidateResult*> cells;
  std::set<double> xs, ys;
  Range range;
  for (const CandidateResult& candidate : results.candidates) {
    const std::optional<double> x = as_number(candidate.values[0]), y = as_number(candidate.values[1]);
    if (!x || !y || !candidate.measured[measure]) continue;
    cells[{*x, *y}] = &candidate;
    range.take(candidate.measured[measure]->mean);
  }
  // Of the grid alone: the baseline may lie beside it.
  for (const auto& [at, candidate] : cells) {
    const auto alike = [&](const auto& same) { return std::count_if(cells.begin(), cells.end(), same); };
    if (alike([&](const auto& other) { return other.first.first == at.first; }) < 2) continue;
    if (alike([&](const auto& other) { return other.first.second == at.second; }) < 2) continue;
    xs.insert(at.first);
    ys.insert(at.second);
  }
  if (xs.size() < 2 || ys.size() < 2 || !(range.high > range.low)) return {};
  const std::vector<double> columns(xs.begin(), xs.end()), rows(ys.begin(), ys.end());
  ChartAxis x{study.vary.begin()->first, 0, 0, {}}, y{std::next(study.vary.begin())->first, 0, 0, {}};
  for (const double value : columns) x.levels.push_back(number_text(value));
  for (const double value : rows) y.levels.push_back(number_text(value));
  Chart chart(kWidth, kHeight, axis_title(measure), x, y);
  const bool more = study_measures()[measure].more_is_better;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const auto found = cells.find({columns[i], rows[j]});
      if (found == cells.end()) continue;
      const double value = found->second->measured[measure]->mean, share = (value - range.low) / (range.high - range.low);
      const double cx = static_cast<double>(i), cy = static_cast<double>(j), merit = more ? share : 1.0 - share;
      chart.cell(cx - 0.48, cy - 0.48, cx + 0.48, cy + 0.48, ramp_colour(merit));
      const cv::Scalar ink = merit > 0.6 ? cv::Scalar(30, 30, 30) : cv::Scalar(255, 255, 255);
      chart.label(cx, cy, number("%.3g", value), ink, -18, 5);
      const bool best = results.best && results.candidates[*results.best].number == found->second->number;
      const std::string mark = found->second->number != 0 ? (best ? "best" : "") : best ? "baseline, best" : "baseline";
      chart.label(cx, cy, mark, ink, -4 * static_cast<int>(mark.size()), 22);
    }
  }
  return chart.image();
}

}  // namespace

std::vector<NamedPicture> study_plots(const StudyConfig& study, const StudyResults& results) {
  std::vector<NamedPicture> plots;
  const auto add = [&plots](const std::string& name, const cv::Mat& image) {
    if (!image.empty()) plots.push_back({name, image});
  };
  add("pareto", pareto_plot(study, results));
  for (const std::string& measure : study.judge.measures) {
    add("effects-" + measure, effects_plot(results, measure));
    if (study.vary.size() == 2) add("field-" + measure, field_plot(study, results, *study_measure(measure)));
  }
  return plots;
}

}  // namespace waretwin
