// Two trajectories compared by rules: what `waretwin score` says of them. docs/metrics.md explains each figure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/score/trajectory_rules.h"
#include "harness/score/trajectory_score.h"

namespace waretwin {

struct ErrorFigures {
  double rmse = 0.0, mean = 0.0, median = 0.0, std = 0.0, min = 0.0, max = 0.0;  // std with the divisor n, as in evo and TUM's tools
};

struct TrajectoryComparison {
  TrajectoryRules rules;
  int estimate_poses = 0, truth_poses = 0, matched_poses = 0;
  ErrorFigures ate_m;          // by the rules' alignment
  ErrorFigures ate_aligned_m;  // after SE(3) alignment
  ErrorFigures ate_plain_m;    // as it is
  int rpe_pairs = 0;
  std::optional<ErrorFigures> rpe_trans_m, rpe_rot_deg;  // nothing where one pose alone was matched
};

// Throws Error where no poses belong together, where several do but none are rpe_delta apart, and for seconds without stamps.
TrajectoryComparison compare_trajectories(const Trajectory& estimate, const Trajectory& truth, const TrajectoryRules& rules);

// score.json of two trajectories.
std::string score_json(const TrajectoryComparison& comparison);

}  // namespace waretwin
