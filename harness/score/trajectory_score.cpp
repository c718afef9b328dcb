#include "harness/score/trajectory_score.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

const StampedPose& nearest(const std::vector<StampedPose>& poses, Stamp stamp) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp, [](const StampedPose& p, Stamp s) { return p.stamp < s; });
  if (after == poses.begin()) return *after;
  if (after == poses.end()) return poses.back();
  const auto before = std::prev(after);
  return stamp - before->stamp <= after->stamp - stamp ? *before : *after;
}

}  // namespace

MatchedPoses match_poses(const Trajectory& estimate, const Trajectory& truth, Stamp max_difference, Stamp time_offset) {
  if (estimate.has_stamps != truth.has_stamps) throw Error("one trajectory has stamps (TUM), the other has none (KITTI)");
  MatchedPoses matched;
  const auto add = [&](const StampedPose& estimated, const StampedPose& true_pose) {
    matched.poses.emplace_back(estimated.X_WB, true_pose.X_WB);
    matched.stamps.push_back(estimated.stamp + time_offset);
  };
  if (!estimate.has_stamps) {
    if (estimate.poses.size() != truth.poses.size()) {
      throw Error("the trajectories have " + std::to_string(estimate.poses.size()) + " and " + std::to_string(truth.poses.size()) +
                  " rows; without stamps they must be equally long");
    }
    for (std::size_t i = 0; i < truth.poses.size(); ++i) add(estimate.poses[i], truth.poses[i]);
  } else if (estimate.poses.size() <= truth.poses.size()) {
    for (const StampedPose& point : estimate.poses) {
      const StampedPose& partner = nearest(truth.poses, point.stamp + time_offset);
      if (std::abs(partner.stamp - point.stamp - time_offset) <= max_difference) add(point, partner);
    }
  } else {
    for (const StampedPose& point : truth.poses) {
      const StampedPose& partner = nearest(estimate.poses, point.stamp - time_offset);
      if (std::abs(partner.stamp + time_offset - point.stamp) <= max_difference) add(partner, point);
    }
  }
  if (matched.poses.empty())
    throw Error("no stamps of the two trajectories are within " + std::to_string(to_seconds(max_difference)) + " s");
  return matched;
}

std::vector<std::pair<Pose, Pose>> associate_poses(const Trajectory& estimate, const Trajectory& truth, Stamp max_difference) {
  return match_poses(estimate, truth, max_difference, 0).poses;
}

RelativeError relative_error(const std::pair<Pose, Pose>& from, const std::pair<Pose, Pose>& to) {
  const Pose estimated_step = from.first.inverse() * to.first;
  const Pose true_step = from.second.inverse() * to.second;
  return {(true_step.inverse() * estimated_step).translation(), rotation_between(true_step, estimated_step)};
}

Pose align_trajectory(const std::vector<std::pair<Pose, Pose>>& pairs) {
  Eigen::Vector3d estimate_mean = Eigen::Vector3d::Zero(), truth_mean = Eigen::Vector3d::Zero();
  for (const auto& [estimate, truth] : pairs) {
    estimate_mean += estimate.translation();
    truth_mean += truth.translation();
  }
  estimate_mean /= static_cast<double>(pairs.size());
  truth_mean /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [estimate, truth] : pairs) {
    covariance += (truth.translation() - truth_mean) * (estimate.translation() - estimate_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  // The best orthogonal matrix may be a reflection; the best rotation gives up the weakest direction.
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) flip(2, 2) = -1.0;
  Pose X_TE = Pose::Identity();
  X_TE.linear() = svd.matrixU() * flip * svd.matrixV().transpose();
  X_TE.translation() = truth_mean - X_TE.linear() * estimate_mean;
  return X_TE;
}

TrajectoryScore score_trajectory(const std::vector<std::pair<Pose, Pose>>& pairs, TrajectoryAlignment alignment) {
  WARETWIN_CHECK(!pairs.empty(), "a trajectory score needs poses");
  const Pose X_TE = alignment == TrajectoryAlignment::kSe3 ? align_trajectory(pairs) : Pose::Identity();
  TrajectoryScore score;
  score.pairs = static_cast<int>(pairs.size());
  double sum = 0.0, squares = 0.0;
  for (const auto& [estimate, truth] : pairs) {
    const double error = (X_TE * estimate.translation() - truth.translation()).norm();
    sum += error;
    squares += error * error;
    score.ate_max_m = std::max(score.ate_max_m, error);
  }
  const auto count = static_cast<double>(pairs.size());
  score.ate_mean_m = sum / count;
  score.ate_rmse_m = std::sqrt(squares / count);
  if (pairs.size() < 2) return score;

  double translation_squares = 0.0, rotation_squares = 0.0;
  for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
    const RelativeError error = relative_error(pairs[i], pairs[i + 1]);
    translation_squares += error.translation.squaredNorm();
    rotation_squares += error.angle * error.angle;
  }
  score.rpe_trans_m = std::sqrt(translation_squares / (count - 1.0));
  score.rpe_rot_deg = to_degrees(std::sqrt(rotation_squares / (count - 1.0)));
  return score;
}

}  // namespace waretwin
