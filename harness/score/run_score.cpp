#include "harness/score/run_score.h"

#include <algorithm>
#include <cmath>

#include "harness/score/alignment.h"

namespace waretwin {

namespace {

double quantile(const std::vector<double>& sorted, double q) {
  const double position = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

TimingSummary summarise_timing(std::vector<double> values_ms) {
  if (values_ms.empty()) return {};
  std::sort(values_ms.begin(), values_ms.end());
  return {quantile(values_ms, 0.5), quantile(values_ms, 0.95), values_ms.back()};
}

ComparedLists compare_lists(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth, const ScoringRules& rules) {
  ComparedLists compared;
  compared.plain = score_objects(mapped, truth, rules);
  compared.explanations = explain(mapped, truth, compared.plain, rules);
  compared.X_TM = align_map_to_truth(mapped, truth, compared.plain);
  if (compared.X_TM) compared.aligned = score_objects(moved(mapped, *compared.X_TM), truth, rules);
  return compared;
}

}  // namespace waretwin
