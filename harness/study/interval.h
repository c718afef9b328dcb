// A mean and how far it can be trusted.
#pragma once

#include <optional>
#include <vector>

namespace waretwin {

struct Interval {
  double mean = 0.0;
  std::optional<double> low, high;  // nothing where one value says nothing of its scatter
  int count = 0;                    // of values
};

// Student's t interval of the mean, for values that are independent and about normal. Nothing for no values; `confidence` in (0, 1).
std::optional<Interval> mean_interval(const std::vector<double>& values, double confidence);

}  // namespace waretwin
