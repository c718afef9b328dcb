// Moments and distances of samples, for tests that hold random numbers against their declared distribution.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace waretwin::test {

inline double sample_mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

inline double sample_variance(const std::vector<double>& x) {
  const double centre = sample_mean(x);
  double sum = 0.0;
  for (const double v : x) sum += (v - centre) * (v - centre);
  return sum / static_cast<double>(x.size() - 1);
}

inline double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double mx = sample_mean(x);
  const double my = sample_mean(y);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mx) * (y[i] - my);
  return sum / (static_cast<double>(x.size() - 1) * std::sqrt(sample_variance(x) * sample_variance(y)));
}

inline double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Kolmogorov-Smirnov distance of samples from a continuous distribution; below 1.63 / sqrt(n) at 99 % confidence.
template <class Cdf>
double ks_distance(std::vector<double> x, Cdf cdf) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p = cdf(x[i]);
    worst = std::max({worst, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  return worst;
}

// Bounds of a sample variance over the true one at 99 % confidence: the chi-square distribution of n - 1 degrees of freedom, by Wilson
// and Hilferty's approximation (good to four digits above 50 degrees).
inline double chi_square_ratio(std::size_t n, double z) {
  const double k = static_cast<double>(n - 1);
  const double root = 1.0 - 2.0 / (9.0 * k) + z * std::sqrt(2.0 / (9.0 * k));
  return root * root * root;
}
inline double variance_ratio_low(std::size_t n) { return chi_square_ratio(n, -2.576); }
inline double variance_ratio_high(std::size_t n) { return chi_square_ratio(n, 2.576); }

}  // namespace waretwin::test
