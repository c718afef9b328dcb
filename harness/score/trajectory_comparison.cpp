#include "harness/score/trajectory_comparison.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/statistics.h"
#include "core/version.h"
#include "harness/score/relative_pairs.h"
#include "harness/score/score_json.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

ErrorFigures figures_of(const std::vector<double>& errors) {
  const double centre = mean(errors);
  std::vector<double> deviations;
  for (const double error : errors) deviations.push_back(error - centre);
  const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
  return {rmse(errors), centre, median(errors), rmse(deviations), *least, *most};
}

ErrorFigures position_figures(const MatchedPoses& matched, const Pose& X_TE) {
  std::vector<double> errors;
  for (const auto& [estimate, truth] : matched.poses) errors.push_back((X_TE * estimate.translation() - truth.translation()).norm());
  return figures_of(errors);
}

// Poses and stamps of the one that the rules measure by.
std::vector<PosePair> chosen_pairs(const MatchedPoses& matched, const TrajectoryRules& rules) {
  std::vector<Pose> poses;
  for (const auto& [estimate, truth] : matched.poses) poses.push_back(rules.rpe_from == "truth" ? truth : estimate);
  return relative_pairs(poses, matched.stamps, rules);
}

void add_relative_errors(TrajectoryComparison& comparison, const MatchedPoses& matched) {
  if (matched.poses.size() < 2) return;
  const std::vector<PosePair> pairs = chosen_pairs(matched, comparison.rules);
  if (pairs.empty()) {
    std::ostringstream delta;
    delta << comparison.rules.rpe_delta << " " << comparison.rules.rpe_unit;
    throw Error("trajectory.rpe_delta is " + delta.str() + ", but of the " + std::to_string(matched.poses.size()) + " matched poses no " +
                comparison.rules.rpe_pairs + " pair is so far apart; expected less");
  }
  std::vector<double> translations_m, rotations_deg;
  for (const PosePair& pair : pairs) {
    const RelativeError error = relative_error(matched.poses[pair.from], matched.poses[pair.to]);
    translations_m.push_back(error.translation.norm());
    rotations_deg.push_back(to_degrees(error.angle));
  }
  comparison.rpe_pairs = static_cast<int>(pairs.size());
  comparison.rpe_trans_m = figures_of(translations_m);
  comparison.rpe_rot_deg = figures_of(rotations_deg);
}

Json figures_json(const ErrorFigures& f) {
  return {{"rmse", f.rmse}, {"mean", f.mean}, {"median", f.median}, {"std", f.std}, {"min", f.min}, {"max", f.max}};
}

Json rules_json(const TrajectoryRules& rules) {
  return {{"alignment", rules.alignment},         {"max_time_difference_s", rules.max_time_difference_s},
          {"time_offset_s", rules.time_offset_s}, {"rpe_delta", rules.rpe_delta},
          {"rpe_unit", rules.rpe_unit},           {"rpe_pairs", rules.rpe_pairs},
          {"rpe_tolerance", rules.rpe_tolerance}, {"rpe_from", rules.rpe_from}};
}

}  // namespace

TrajectoryComparison compare_trajectories(const Trajectory& estimate, const Trajectory& truth, const TrajectoryRules& rules) {
  if (rules.rpe_unit == "seconds" && !(estimate.has_stamps && truth.has_stamps)) {
    throw Error("trajectory.rpe_unit is seconds, but the trajectories have no stamps (KITTI); expected frames, metres or degrees");
  }
  const MatchedPoses matched = match_poses(estimate, truth, from_seconds(rules.max_time_difference_s), from_seconds(rules.time_offset_s));
  TrajectoryComparison comparison;
  comparison.rules = rules;
  comparison.estimate_poses = static_cast<int>(estimate.poses.size());
  comparison.truth_poses = static_cast<int>(truth.poses.size());
  comparison.matched_poses = static_cast<int>(matched.poses.size());
  comparison.ate_plain_m = position_figures(matched, Pose::Identity());
  comparison.ate_aligned_m = position_figures(matched, align_trajectory(matched.poses));
  comparison.ate_m = rules.alignment == "none" ? comparison.ate_plain_m : comparison.ate_aligned_m;
  add_relative_errors(comparison, matched);
  return comparison;
}

std::string score_json(const TrajectoryComparison& comparison) {
  const auto rmse_of = [](const std::optional<ErrorFigures>& figures) { return figures ? Json(figures->rmse) : Json(nullptr); };
  const auto all_of = [](const std::optional<ErrorFigures>& figures) { return figures ? figures_json(*figures) : Json(nullptr); };
  Json json = {{"schema", kScoreSchema}, {"version", kVersion}};
  json["trajectory"] = {
      {"ate_rmse_m", comparison.ate_m.rmse},
      {"ate_max_m", comparison.ate_m.max},
      {"ate_mean_m", comparison.ate_m.mean},
      {"ate_median_m", comparison.ate_m.median},
      {"ate_std_m", comparison.ate_m.std},
      {"ate_min_m", comparison.ate_m.min},
      {"rpe_trans_m", rmse_of(comparison.rpe_trans_m)},
      {"rpe_rot_deg", rmse_of(comparison.rpe_rot_deg)},
      {"poses", comparison.matched_poses},
      {"alignment", comparison.rules.alignment},
      {"ate_unaligned_rmse_m", comparison.ate_plain_m.rmse},
      {"ate_unaligned_max_m", comparison.ate_plain_m.max},
      {"ate_aligned_rmse_m", comparison.ate_aligned_m.rmse},
      {"ate_aligned_max_m", comparison.ate_aligned_m.max},
      {"rpe", {{"pairs", comparison.rpe_pairs}, {"trans_m", all_of(comparison.rpe_trans_m)}, {"rot_deg", all_of(comparison.rpe_rot_deg)}}},
      {"poses_estimate", comparison.estimate_poses},
      {"poses_truth", comparison.truth_poses},
      {"settings", rules_json(comparison.rules)}};
  return json.dump(2) + "\n";
}

}  // namespace waretwin
