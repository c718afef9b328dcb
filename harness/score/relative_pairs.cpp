#include "harness/score/relative_pairs.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

// Only angles can have more pairs than poses; a list of these takes 320 MB.
constexpr std::size_t kMaxPairs = 20'000'000;

std::vector<PosePair> by_frames(std::size_t poses, const TrajectoryRules& rules) {
  std::vector<PosePair> pairs;
  if (rules.rpe_delta >= static_cast<double>(poses)) return pairs;
  const auto delta = static_cast<std::size_t>(rules.rpe_delta);
  const std::size_t step = rules.rpe_pairs == "all" ? 1 : delta;
  for (std::size_t i = 0; i + delta < poses; i += step) pairs.push_back({i, i + delta});
  return pairs;
}

// steps[i] leads from pose i to i + 1. The sum starts afresh at every chosen pose, so that steps of 0.1 reach 1 at the same pose each time.
std::vector<PosePair> consecutive(const std::vector<double>& steps, double delta, bool start_is_chosen) {
  std::vector<PosePair> pairs;
  std::size_t last = 0;
  bool chosen = start_is_chosen;
  double grown = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    grown += steps[i];
    if (grown < delta) continue;
    if (chosen) pairs.push_back({last, i + 1});
    last = i + 1;
    chosen = true;
    grown = 0.0;
  }
  return pairs;
}

std::vector<PosePair> nearest_to_delta(const std::vector<double>& steps, double delta, double tolerance) {
  std::vector<double> path(steps.size() + 1, 0.0);
  for (std::size_t i = 0; i < steps.size(); ++i) path[i + 1] = path[i] + steps[i];
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const auto later = path.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto off = [&](auto at) { return std::abs(*at - path[i] - delta); };
    auto best = std::partition_point(later, path.end(), [&](double p) { return p - path[i] < delta; });
    if (best == path.end() || (best != later && off(best - 1) <= off(best))) {
      // Of poses at one place (the robot stands) the first.
      best = std::lower_bound(later, path.end(), *(best - 1));
    }
    if (off(best) <= tolerance) pairs.push_back({i, static_cast<std::size_t>(best - path.begin())});
  }
  return pairs;
}

std::vector<PosePair> by_direct_angle(const std::vector<Pose>& poses, double delta, double tolerance) {
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      if (std::abs(rotation_between(poses[i], poses[j]) - delta) > tolerance) continue;
      if (pairs.size() == kMaxPairs)
        throw Error("trajectory.rpe_pairs is all: more than 20 million pairs; expected a smaller rpe_tolerance");
      pairs.push_back({i, j});
    }
  }
  return pairs;
}

}  // namespace

std::vector<PosePair> relative_pairs(const std::vector<Pose>& poses, const std::vector<Stamp>& stamps, const TrajectoryRules& rules) {
  if (rules.rpe_unit == "frames") return by_frames(poses.size(), rules);
  const bool all = rules.rpe_pairs == "all", degrees = rules.rpe_unit == "degrees", seconds = rules.rpe_unit == "seconds";
  // Seconds are counted in whole nanoseconds, which doubles hold exactly for a hundred days.
  const double delta = degrees   ? to_radians(rules.rpe_delta)
                       : seconds ? static_cast<double>(from_seconds(rules.rpe_delta))
                                 : rules.rpe_delta;
  const double tolerance = delta * rules.rpe_tolerance;
  if (all && degrees) return by_direct_angle(poses, delta, tolerance);
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    steps.push_back(degrees   ? rotation_between(poses[i], poses[i + 1])
                    : seconds ? static_cast<double>(stamps[i + 1] - stamps[i])
                              : (poses[i + 1].translation() - poses[i].translation()).norm());
  }
  if (all) return nearest_to_delta(steps, delta, tolerance);
  return consecutive(steps, delta, degrees || seconds);
}

}  // namespace waretwin
