// What each level of each factor does, all else being equal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/study/interval.h"

namespace waretwin {

// One candidate's level of each factor (an index from 0) and what it was measured at.
struct LevelledValue {
  std::vector<std::size_t> levels;
  double value = 0.0;
};

// For each factor and each of its `level_counts` levels the mean that candidates of the level would have if they were spread evenly over
// the levels of all other factors: least squares of value = constant + one term a factor. So factors that vary together, as in random
// designs, are told apart where the data can. Intervals come from the residuals (Student's t): none where there are no degrees of freedom
// left. Where terms cannot be told apart, plain means without intervals. A level that no value has is nothing.
std::vector<std::vector<std::optional<Interval>>> main_effects(const std::vector<LevelledValue>& values,
                                                               const std::vector<std::size_t>& level_counts, double confidence);

}  // namespace waretwin
