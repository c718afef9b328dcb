#include "core/statistics.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"

namespace waretwin {

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double rmse(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double standard_deviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double centre = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double percentile(std::vector<double> values, double percent) {
  if (!(percent >= 0.0 && percent <= 100.0)) throw Error("percentile " + std::to_string(percent) + "; expected 0 to 100");
  if (values.empty()) return 0.0;
  const double place = percent / 100.0 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), low, values.end());
  const double share = place - static_cast<double>(below);
  if (share == 0.0) return *low;
  return *low + share * (*std::min_element(low + 1, values.end()) - *low);
}

double median(std::vector<double> values) { return percentile(std::move(values), 50.0); }

}  // namespace waretwin
