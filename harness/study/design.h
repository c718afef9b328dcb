// Which points of the space of factors a study looks at.
#pragma once

#include <string>
#include <vector>

#include "harness/study/study_config.h"

namespace waretwin {

// A value for each factor, in the order of StudyConfig::vary (by name). Numbers in their shortest form.
using DesignPoint = std::vector<std::string>;

// grid: every combination, the first factor varying slowest. list: the factors' values side by side. random: `points` independent uniform
// draws. sobol: the first `points` of a Sobol' sequence (Joe and Kuo's directions), which fills the space evenly; ranges are rounded
// (Factor::multiple_of), lists of values are equal parts of it. Without repetitions. Throws Error for more points than a study can hold.
std::vector<DesignPoint> design_points(const StudyConfig& study);

constexpr std::size_t kMostCandidates = 100000;

}  // namespace waretwin
