// How far a trajectory is from the true one: ATE and RPE as the TUM RGB-D benchmark (Sturm et al. 2012) and evo define them.
#pragma once

#include <utility>
#include <vector>

#include "harness/score/trajectory_file.h"

namespace waretwin {

enum class TrajectoryAlignment {
  kNone,
  kSe3  // rigid motion that minimises the squared distances of the positions (Horn 1987, Umeyama 1991 without scale)
};

struct TrajectoryScore {
  int pairs = 0;
  double ate_rmse_m = 0.0, ate_mean_m = 0.0, ate_max_m = 0.0;
  // Root mean square over consecutive pairs; alignment has no influence.
  double rpe_trans_m = 0.0;  // of the translation of (Q_i^-1 Q_i+1)^-1 (P_i^-1 P_i+1), P estimate, Q truth
  double rpe_rot_deg = 0.0;  // of its rotation angle
};

// Estimated and true poses that belong together: every pose of the shorter list with the nearest stamp of the other one, where that is at
// most `max_difference` away. Without stamps (KITTI) by row; the lists must then be equally long. Throws Error where nothing matches.
std::vector<std::pair<Pose, Pose>> associate_poses(const Trajectory& estimate, const Trajectory& truth, Stamp max_difference = 10'000'000);

// The rigid motion X_TE that lays the estimated positions over the true ones. For positions on one line the rotation about it is the
// smallest possible by the decomposition, not determined by the data.
Pose align_trajectory(const std::vector<std::pair<Pose, Pose>>& pairs);

// `pairs` must not be empty.
TrajectoryScore score_trajectory(const std::vector<std::pair<Pose, Pose>>& pairs, TrajectoryAlignment alignment);

}  // namespace waretwin
