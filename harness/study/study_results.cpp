#include "harness/study/study_results.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "core/statistics.h"
#include "harness/score/number_text.h"
#include "harness/study/condition.h"
#include "harness/study/main_effects.h"

namespace waretwin {

namespace {

constexpr std::size_t kMostLevels = 8, kBins = 4;

// All values of one measure, with what they belong to: the drive, or for coverage the hall.
std::map<std::pair<std::string, std::uint64_t>, double> values_of(const CandidateResult& candidate, std::size_t measure) {
  std::map<std::pair<std::string, std::uint64_t>, double> values;
  if (study_measures()[measure].source == MeasureSource::kCoverage) {
    for (const auto& [hall, coverage] : candidate.halls) {
      if (coverage[measure]) values[{hall, 0}] = *coverage[measure];
    }
    return values;
  }
  for (const StudyRunResult& run : candidate.runs) {
    if (run.error.empty() && run.values[measure]) values[{run.hall, run.seed}] = *run.values[measure];
  }
  return values;
}

void measure(CandidateResult& candidate, const CandidateResult& baseline, double confidence) {
  const std::size_t count = study_measures().size();
  candidate.measured.assign(count, std::nullopt);
  candidate.difference.assign(count, std::nullopt);
  for (std::size_t m = 0; m < count; ++m) {
    const auto own = values_of(candidate, m), others = values_of(baseline, m);
    std::vector<double> all, differences;
    for (const auto& [drive, value] : own) {
      all.push_back(value);
      const auto other = others.find(drive);
      if (other != others.end()) differences.push_back(value - other->second);
    }
    candidate.measured[m] = mean_interval(all, confidence);
    if (candidate.number != baseline.number) candidate.difference[m] = mean_interval(differences, confidence);
  }
}

// Of each measure the drives (of coverage: the halls) in which any candidate has a value. Who has none where others have one did not do
// as well there, but worse: no object was found whose error could be measured.
std::vector<std::size_t> drives_of_measures(const std::vector<CandidateResult>& candidates) {
  std::vector<std::size_t> counts;
  for (std::size_t m = 0; m < study_measures().size(); ++m) {
    std::set<std::pair<std::string, std::uint64_t>> drives;
    for (const CandidateResult& candidate : candidates) {
      if (study_measures()[m].source == MeasureSource::kRun && candidate.state != CandidateState::kMapped) continue;
      for (const auto& entry : values_of(candidate, m)) drives.insert(entry.first);
    }
    counts.push_back(drives.size());
  }
  return counts;
}

// How good, more is better.
double merit(const CandidateResult& candidate, std::size_t measure) {
  const double mean = candidate.measured[measure]->mean;
  return study_measures()[measure].more_is_better ? mean : -mean;
}

bool dominates(const CandidateResult& a, const CandidateResult& b, const std::vector<std::size_t>& measures) {
  bool better = false;
  for (const std::size_t m : measures) {
    if (merit(a, m) < merit(b, m)) return false;
    better = better || merit(a, m) > merit(b, m);
  }
  return better;
}

std::vector<std::size_t> indices_of(const std::vector<std::string>& names) {
  std::vector<std::size_t> indices;
  for (const std::string& name : names) indices.push_back(*study_measure(name));
  return indices;
}

// Compared with others by a measure: it has a value wherever anybody has one.
bool comparable(const CandidateResult& candidate, std::size_t m, const std::vector<std::size_t>& drives) {
  return candidate.measured[m] && static_cast<std::size_t>(candidate.measured[m]->count) == drives[m];
}

void find_front(std::vector<CandidateResult>& candidates, const std::vector<std::size_t>& measures, const std::vector<std::size_t>& drives,
                bool mapped) {
  std::vector<CandidateResult*> able;
  for (CandidateResult& candidate : candidates) {
    if (mapped && candidate.state != CandidateState::kMapped) continue;
    const bool all = std::all_of(measures.begin(), measures.end(), [&](std::size_t m) { return comparable(candidate, m, drives); });
    if (candidate.feasible() && all) able.push_back(&candidate);
  }
  for (CandidateResult* candidate : able) {
    candidate->on_front =
        std::none_of(able.begin(), able.end(), [&](const CandidateResult* other) { return dominates(*other, *candidate, measures); });
  }
}

// By the first measure; what is equal there by the next ones, then by number.
std::optional<std::size_t> find_best(const std::vector<CandidateResult>& candidates, const std::vector<std::size_t>& measures,
                                     const std::vector<std::size_t>& drives, bool mapped) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const CandidateResult& candidate = candidates[i];
    if (!candidate.feasible() || !comparable(candidate, measures.front(), drives)) continue;
    if (mapped && candidate.state != CandidateState::kMapped) continue;
    if (!best) {
      best = i;
      continue;
    }
    for (const std::size_t m : measures) {
      if (!comparable(candidate, m, drives) || !comparable(candidates[*best], m, drives)) continue;
      const double own = merit(candidate, m), other = merit(candidates[*best], m);
      if (own > other) best = i;
      if (own != other) break;
    }
  }
  return best;
}

struct Level {
  std::string name;
  std::set<std::string> values;
};

std::vector<Level> levels_of(const std::vector<const CandidateResult*>& candidates, std::size_t factor) {
  std::vector<std::string> words;
  std::vector<std::pair<double, std::string>> numbers;
  for (const CandidateResult* candidate : candidates) {
    const std::string& value = candidate->values[factor];
    const std::optional<double> number = as_number(value);
    if (number) numbers.emplace_back(*number, value);
    if (std::find(words.begin(), words.end(), value) == words.end()) words.push_back(value);
  }
  std::vector<Level> levels;
  if (numbers.size() != candidates.size()) {
    for (const std::string& word : words) levels.push_back({word, {word}});
    return levels;
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::string> distinct;
  for (const auto& entry : numbers) {
    if (distinct.empty() || distinct.back() != entry.second) distinct.push_back(entry.second);
  }
  if (distinct.size() <= kMostLevels) {
    for (const std::string& value : distinct) levels.push_back({value, {value}});
    return levels;
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const std::size_t begin = distinct.size() * bin / kBins, end = distinct.size() * (bin + 1) / kBins;
    const auto text = [&](std::size_t k) { return number("%.3g", as_number(distinct[k])); };
    levels.push_back({text(begin) + " to " + text(end - 1),
                      {distinct.begin() + static_cast<std::ptrdiff_t>(begin), distinct.begin() + static_cast<std::ptrdiff_t>(end)}});
  }
  return levels;
}

// Of the design alone: a baseline that shares no level with the others would be a level by itself.
bool in_design(const std::vector<CandidateResult>& candidates, std::size_t i) {
  if (i > 0) return true;
  for (std::size_t factor = 0; factor < candidates[i].values.size(); ++factor) {
    const bool shared = std::any_of(candidates.begin() + 1, candidates.end(),
                                    [&](const CandidateResult& other) { return other.values[factor] == candidates[i].values[factor]; });
    if (!shared) return false;
  }
  return true;
}

std::vector<FactorEffect> effects_of(const StudyConfig& study, const std::vector<CandidateResult>& all) {
  std::vector<const CandidateResult*> candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (in_design(all, i)) candidates.push_back(&all[i]);
  }
  std::vector<std::vector<Level>> levels;
  std::vector<std::size_t> counts;
  for (std::size_t factor = 0; factor < study.vary.size(); ++factor) {
    levels.push_back(levels_of(candidates, factor));
    counts.push_back(levels.back().size());
  }
  std::vector<FactorEffect> effects;
  for (const std::string& name : study.judge.measures) {
    const std::size_t m = *study_measure(name);
    std::vector<LevelledValue> values;
    for (const CandidateResult* candidate : candidates) {
      if (!candidate->measured[m]) continue;
      LevelledValue& value = values.emplace_back();
      value.value = candidate->measured[m]->mean;
      for (std::size_t factor = 0; factor < levels.size(); ++factor) {
        const auto found = std::find_if(levels[factor].begin(), levels[factor].end(),
                                        [&](const Level& level) { return level.values.contains(candidate->values[factor]); });
        value.levels.push_back(static_cast<std::size_t>(found - levels[factor].begin()));
      }
    }
    const auto all_effects = main_effects(values, counts, study.judge.confidence);
    std::size_t factor = 0;
    for (const auto& entry : study.vary) {
      FactorEffect effect{entry.first, name, {}};
      for (std::size_t level = 0; level < counts[factor]; ++level) {
        if (all_effects[factor][level]) effect.levels.push_back({levels[factor][level].name, *all_effects[factor][level]});
      }
      ++factor;
      // What no level changes is no effect.
      constexpr double kNone = 1e-12;
      if (effect.levels.size() > 1 && effect.range() > kNone) effects.push_back(std::move(effect));
    }
  }
  return effects;
}

}  // namespace

const char* name_of(CandidateState state) {
  switch (state) {
    case CandidateState::kRefused:
      return "refused";
    case CandidateState::kScreenedOut:
      return "screened_out";
    case CandidateState::kMapped:
      return "run";
  }
  return "";
}

double FactorEffect::range() const {
  double low = levels.front().interval.mean, high = low;
  for (const EffectLevel& level : levels) {
    low = std::min(low, level.interval.mean);
    high = std::max(high, level.interval.mean);
  }
  return high - low;
}

std::optional<std::string> broken_by_values(const StudyConfig& study, const DesignPoint& values) {
  for (const std::string& text : study.constraints) {
    const Condition condition = Condition::parse(text);
    std::size_t index = 0;
    for (const auto& entry : study.vary) {
      const std::string& value = values[index++];
      if (entry.first == condition.name() && !condition.holds(std::optional(value))) return condition.text() + " does not hold: " + value;
    }
  }
  return std::nullopt;
}

std::vector<std::string> broken_by_measures(const StudyConfig& study, const StudyValues& means, MeasureSource source) {
  std::vector<std::string> broken;
  for (const std::string& text : study.constraints) {
    const Condition condition = Condition::parse(text);
    const std::optional<std::size_t> m = study_measure(condition.name());
    if (!m || study_measures()[*m].source != source || condition.holds(means[*m])) continue;
    broken.push_back(condition.text() + " does not hold: " + (means[*m] ? number_text(*means[*m]) : "it has no value in every drive"));
  }
  return broken;
}

std::vector<const CandidateResult*> ranked(const StudyResults& results) {
  const std::size_t by = *study_measure(results.best_by);
  const double sign = study_measures()[by].more_is_better ? -1.0 : 1.0;
  std::vector<const CandidateResult*> list;
  for (const CandidateResult& candidate : results.candidates) {
    if (candidate.measured[by]) list.push_back(&candidate);
  }
  std::stable_sort(list.begin(), list.end(), [&](const CandidateResult* a, const CandidateResult* b) {
    if (a->feasible() != b->feasible()) return a->feasible();
    return sign * a->measured[by]->mean < sign * b->measured[by]->mean;
  });
  return list;
}

StudyValues mean_coverage(const CandidateResult& candidate) {
  StudyValues means(study_measures().size());
  for (std::size_t m = 0; m < means.size(); ++m) {
    if (study_measures()[m].source != MeasureSource::kCoverage) continue;
    std::vector<double> values;
    for (const auto& entry : values_of(candidate, m)) values.push_back(entry.second);
    if (!values.empty()) means[m] = mean(values);
  }
  return means;
}

StudyResults judged_study(const StudyConfig& study, std::vector<CandidateResult> candidates) {
  WARETWIN_CHECK(!candidates.empty(), "the baseline is always there");
  StudyResults results;
  for (CandidateResult& candidate : candidates) {
    measure(candidate, candidates.front(), study.judge.confidence);
    results.mapped = results.mapped || !candidate.runs.empty();
  }
  const std::vector<std::size_t> drives = drives_of_measures(candidates);
  for (CandidateResult& candidate : candidates) {
    for (const StudyRunResult& run : candidate.runs) {
      if (!run.error.empty()) candidate.broken.push_back(run.hall + ", seed " + std::to_string(run.seed) + ": " + run.error);
    }
    if (candidate.runs.empty()) continue;
    StudyValues means(study_measures().size());
    for (std::size_t m = 0; m < means.size(); ++m) {
      if (comparable(candidate, m, drives)) means[m] = candidate.measured[m]->mean;
    }
    for (std::string& text : broken_by_measures(study, means, MeasureSource::kRun)) candidate.broken.push_back(std::move(text));
  }
  results.best_by = results.mapped ? study.judge.best_by : study.screen.by;
  results.pareto = study.judge.pareto;
  if (!results.mapped) results.pareto = {study.screen.by, study.screen.by == "floor_coverage" ? "object_coverage" : "floor_coverage"};
  find_front(candidates, indices_of(results.pareto), drives, results.mapped);
  std::vector<std::size_t> order = {*study_measure(results.best_by)};
  for (const std::size_t m : indices_of(study.judge.measures)) order.push_back(m);
  results.best = find_best(candidates, order, drives, results.mapped);
  results.effects = effects_of(study, candidates);
  results.candidates = std::move(candidates);
  return results;
}

}  // namespace waretwin
