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

struct MatchedPoses {
  std::vector<std::pair<Pose, Pose>> poses;  // estimated, true
  std::vector<Stamp> stamps;                 // of the estimate, `time_offset` added
};

// Estimated and true poses that belong together, as evo associates them: every pose of the shorter list (of equally long ones, of the
// estimate) with the nearest stamp of the other one, where that is at most `max_difference` away; a pose of the longer list may serve
// twice. Without stamps (KITTI) by row; the lists must then be equally long. Throws Error where nothing matches.
MatchedPoses match_poses(const Trajectory& estimate, const Trajectory& truth, Stamp max_difference, Stamp time_offset);

// The same with usual values: within 10 ms, without an offset.
std::vector<std::pair<Pose, Pose>> associate_poses(const Trajectory& estimate, const Trajectory& truth, Stamp max_difference = 10'000'000);

// By what the estimated motion from one matched pose to another differs from the true one: (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), P estimate,
// Q truth (Sturm et al. 2012, equation 1).
struct RelativeError {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // metres
  double angle = 0.0;                                     // radians, in [0, pi]
};
RelativeError relative_error(const std::pair<Pose, Pose>& from, const std::pair<Pose, Pose>& to);

// The rigid motion X_TE that lays the estimated positions over the true ones. For positions on one line the rotation about it is the
// smallest possible by the decomposition, not determined by the data.
Pose align_trajectory(const std::vector<std::pair<Pose, Pose>>& pairs);

// `pairs` must not be empty.
TrajectoryScore score_trajectory(const std::vector<std::pair<Pose, Pose>>& pairs, TrajectoryAlignment alignment);

}  // namespace waretwin
