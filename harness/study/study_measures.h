// What a study can judge a mount by.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace waretwin {

// Where a measure comes from: looked up by rays alone, or out of a run's score.
enum class MeasureSource { kCoverage, kRun };

struct StudyMeasure {
  std::string name;
  std::string what;
  bool more_is_better = true;
  MeasureSource source = MeasureSource::kRun;
};

// Those of a score (harness/gate/measures.h; without times and memory, which are another every time), then those of coverage. In a study
// every object of the hall counts, also one that a mount sees little of: a mount must not gain by looking away.
const std::vector<StudyMeasure>& study_measures();

// Index into study_measures(); nothing for a name that is none's.
std::optional<std::size_t> study_measure(const std::string& name);

// "recall, precision, ..."
std::string study_measure_names();

// One for each of study_measures(); nothing where it was not measured.
using StudyValues = std::vector<std::optional<double>>;

}  // namespace waretwin
