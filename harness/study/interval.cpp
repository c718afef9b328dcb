#include "harness/study/interval.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core/statistics.h"

namespace waretwin {

std::optional<Interval> mean_interval(const std::vector<double>& values, double confidence) {
  if (values.empty()) return std::nullopt;
  Interval interval{mean(values), std::nullopt, std::nullopt, static_cast<int>(values.size())};
  if (values.size() < 2) return interval;
  const double n = static_cast<double>(values.size());
  const boost::math::students_t t(n - 1.0);
  const double half = boost::math::quantile(t, 0.5 + 0.5 * confidence) * standard_deviation(values) / std::sqrt(n);
  interval.low = interval.mean - half;
  interval.high = interval.mean + half;
  return interval;
}

}  // namespace waretwin
