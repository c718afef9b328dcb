// Figures that sum up a list of numbers: timings, errors, scores. Of no values each of them is 0, so that reports hold no NaN.
#pragma once

#include <vector>

namespace waretwin {

double mean(const std::vector<double>& values);

// Root of the mean square.
double rmse(const std::vector<double>& values);

// Standard deviation with the divisor n - 1; 0 below two values.
double standard_deviation(const std::vector<double>& values);

// The value below which `percent` of the list lies, linear between neighbours: 0 gives the smallest, 50 the median, 100 the largest.
// Throws Error for a percentage outside [0, 100].
double percentile(std::vector<double> values, double percent);

double median(std::vector<double> values);

}  // namespace waretwin
