#include "harness/study/design.h"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <set>

#include "core/dice.h"
#include "core/error.h"
#include "harness/study/condition.h"

namespace waretwin {

namespace {

// Numbers that are written differently are the same level.
std::string level_text(const std::string& text) {
  const std::optional<double> number = as_number(text);
  return number ? number_text(*number) : text;
}

// The value at a share in [0, 1] of a range.
std::string in_range(const Factor& factor, double share) {
  const double low = *factor.from, high = *factor.to;
  const double unit = factor.multiple_of > 0.0 ? factor.multiple_of : std::pow(10.0, std::floor(std::log10(high - low)) - 3.0);
  // Divided by the inverse of small units, so that 1.2 is no 1.2000000000000002.
  const double count = std::round((low + share * (high - low)) / unit);
  const double value = unit < 1.0 ? count / std::round(1.0 / unit) : count * unit;
  return number_text(std::clamp(value, low, high));
}

std::vector<std::string> levels(const Factor& factor) {
  std::vector<std::string> list;
  for (const std::string& value : factor.values) list.push_back(level_text(value));
  if (!factor.is_range()) return list;
  for (int i = 0; i < factor.steps; ++i)
    list.push_back(in_range(factor, factor.steps > 1 ? static_cast<double>(i) / (factor.steps - 1) : 0.0));
  return list;
}

// The value at a share in [0, 1) of the factor's space.
std::string at_share(const Factor& factor, double share) {
  if (factor.is_range()) return in_range(factor, share);
  const auto index = static_cast<std::size_t>(share * static_cast<double>(factor.values.size()));
  return level_text(factor.values[std::min(index, factor.values.size() - 1)]);
}

std::vector<DesignPoint> grid(const StudyConfig& study) {
  std::vector<DesignPoint> points = {{}};
  for (const auto& [name, factor] : study.vary) {
    std::vector<DesignPoint> longer;
    for (const DesignPoint& point : points) {
      for (const std::string& level : levels(factor)) {
        longer.push_back(point);
        longer.back().push_back(level);
      }
      if (longer.size() > kMostCandidates) throw Error("design: the grid has more than " + std::to_string(kMostCandidates) + " points");
    }
    points = std::move(longer);
  }
  return points;
}

std::vector<DesignPoint> list(const StudyConfig& study) {
  std::vector<DesignPoint> points(study.vary.begin()->second.values.size());
  for (const auto& [name, factor] : study.vary) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(level_text(factor.values[i]));
  }
  return points;
}

std::vector<DesignPoint> random_points(const StudyConfig& study) {
  std::vector<DesignPoint> points;
  for (int i = 0; i < study.points; ++i) {
    Dice dice(RandomStream(study.design_seed, "study", "design", i));
    DesignPoint& point = points.emplace_back();
    for (const auto& [name, factor] : study.vary) point.push_back(at_share(factor, dice.unit()));
  }
  return points;
}

std::vector<DesignPoint> sobol(const StudyConfig& study) {
  boost::random::sobol sequence(study.vary.size());
  const double whole = static_cast<double>(boost::random::sobol::max()) + 1.0;
  std::vector<DesignPoint> points;
  for (int i = 0; i < study.points; ++i) {
    DesignPoint& point = points.emplace_back();
    for (const auto& [name, factor] : study.vary) point.push_back(at_share(factor, static_cast<double>(sequence()) / whole));
  }
  return points;
}

}  // namespace

std::vector<DesignPoint> design_points(const StudyConfig& study) {
  std::vector<DesignPoint> points = study.design == "grid"     ? grid(study)
                                    : study.design == "list"   ? list(study)
                                    : study.design == "random" ? random_points(study)
                                                               : sobol(study);
  std::set<DesignPoint> known;
  std::erase_if(points, [&](const DesignPoint& point) { return !known.insert(point).second; });
  return points;
}

}  // namespace waretwin
