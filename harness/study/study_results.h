// What came out of a study: computed from its runs, whoever made them. No times in it, so that any number of machines make the same.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/study/design.h"
#include "harness/study/interval.h"
#include "harness/study/study_config.h"
#include "harness/study/study_measures.h"

namespace waretwin {

// One drive of one candidate.
struct StudyRunResult {
  std::string hall;
  std::uint64_t seed = 0;
  std::string digest;  // of the map
  std::string error;   // why it could not be driven; empty: it was
  StudyValues values;  // MeasureSource::kRun only
};

enum class CandidateState {
  kRefused,      // a constraint on its factors or its coverage does not hold
  kScreenedOut,  // others see more
  kMapped
};
const char* name_of(CandidateState state);  // refused, screened_out, run

struct CandidateResult {
  int number = 0;      // 0: the baseline
  std::string name;    // "c000"
  DesignPoint values;  // of the factors
  CandidateState state = CandidateState::kMapped;
  std::vector<std::string> broken;           // constraints that do not hold, and drives that could not be
  std::map<std::string, StudyValues> halls;  // coverage by hall; MeasureSource::kCoverage only
  std::vector<StudyRunResult> runs;          // halls in order, in each the seeds

  // For each of study_measures(): over all runs (of coverage: over halls), and what of it is over the baseline in the same runs.
  std::vector<std::optional<Interval>> measured, difference;
  bool on_front = false;  // of the Pareto front

  bool feasible() const { return broken.empty(); }
};

// A factor's level, or with more than 8 numbers one of four bins with as many of them each (main_effects.h).
struct EffectLevel {
  std::string level;  // "1.4", "0.8 to 1"
  Interval interval;
};
struct FactorEffect {
  std::string factor, measure;
  std::vector<EffectLevel> levels;
  double range() const;  // between the largest and the smallest mean
};

struct StudyResults {
  std::vector<CandidateResult> candidates;  // the baseline first
  std::vector<std::string> pareto;          // judge.pareto, or measures of coverage where nothing was mapped
  std::string best_by;                      // judge.best_by, or screen.by where nothing was mapped
  std::optional<std::size_t> best;          // among the feasible mapped candidates (where nothing was mapped: among all feasible)
  bool mapped = false;                      // anything
  std::vector<FactorEffect> effects;        // of each factor on each judged measure that it changes
};

// Fills in what follows from values, coverage and runs: `broken` of the measures, intervals, the front, the best, effects.
StudyResults judged_study(const StudyConfig& study, std::vector<CandidateResult> candidates);

// The first constraint on a factor (of a measure, where `means` is given) that does not hold, in words; nothing where all do.
std::optional<std::string> broken_by_values(const StudyConfig& study, const DesignPoint& values);
std::vector<std::string> broken_by_measures(const StudyConfig& study, const StudyValues& means, MeasureSource source);

// Those that have a value of what the best is chosen by, best first; what is not feasible after what is, equal ones by number.
std::vector<const CandidateResult*> ranked(const StudyResults& results);

// Mean of coverage over halls, for each of study_measures(); nothing for those of runs.
StudyValues mean_coverage(const CandidateResult& candidate);

}  // namespace waretwin
