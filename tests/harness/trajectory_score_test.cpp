#include "harness/score/trajectory_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

using Pairs = std::vector<std::pair<Pose, Pose>>;

Pose random_pose(const RandomStream& random, std::uint64_t index) {
  Pose X = Pose::Identity();
  X.linear() = rotation_from_rpy(random.normal(6 * index), random.normal(6 * index + 1), random.normal(6 * index + 2));
  X.translation() = Eigen::Vector3d(random.normal(6 * index + 3), random.normal(6 * index + 4), random.normal(6 * index + 5));
  return X;
}

TEST(TrajectoryScore, MeasuresAConstantOffset) {
  const Pairs pairs = {{make_upright_pose(0, 0.3, 0.4, 0), make_upright_pose(0, 0, 0, 0)},
                       {make_upright_pose(1, 0.3, 0.4, 0), make_upright_pose(1, 0, 0, 0)},
                       {make_upright_pose(1, 1.3, 0.4, 0), make_upright_pose(1, 1, 0, 0)}};
  const TrajectoryScore plain = score_trajectory(pairs, TrajectoryAlignment::kNone);
  EXPECT_NEAR(plain.ate_rmse_m, 0.5, 1e-12);
  EXPECT_NEAR(plain.ate_max_m, 0.5, 1e-12);
  EXPECT_NEAR(plain.rpe_trans_m, 0.0, 1e-12);
  EXPECT_NEAR(score_trajectory(pairs, TrajectoryAlignment::kSe3).ate_rmse_m, 0.0, 1e-9);
}

TEST(TrajectoryScore, MeasuresStepErrorsByHand) {
  // Steps of 1 m come out as 1.1 m, and the second one also turns by 10 deg too much.
  const double turn = to_radians(10.0);
  const Pairs pairs = {{make_upright_pose(0, 0, 0, 0), make_upright_pose(0, 0, 0, 0)},
                       {make_upright_pose(1.1, 0, 0, 0), make_upright_pose(1, 0, 0, 0)},
                       {make_upright_pose(2.2, 0, 0, turn), make_upright_pose(2, 0, 0, 0)}};
  const TrajectoryScore score = score_trajectory(pairs, TrajectoryAlignment::kNone);
  EXPECT_NEAR(score.ate_rmse_m, std::sqrt((0.01 + 0.04) / 3.0), 1e-12);
  EXPECT_NEAR(score.rpe_trans_m, 0.1, 1e-9);
  EXPECT_NEAR(score.rpe_rot_deg, std::sqrt(100.0 / 2.0), 1e-9);
}

TEST(TrajectoryScore, FindsTheRigidMotionBack) {
  const RandomStream random(3, "alignment", "poses");
  const Pose X_TE = random_pose(random, 1000);
  Pairs pairs;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Pose truth = random_pose(random, i);
    pairs.emplace_back(X_TE.inverse() * truth, truth);
  }
  EXPECT_TRUE(align_trajectory(pairs).isApprox(X_TE, 1e-9));
}

// No rotation or shift near the returned one does better: a slow check of the least squares.
TEST(TrajectoryScore, AlignsAtTheMinimum) {
  const RandomStream random(4, "alignment", "noise");
  Pairs pairs;
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Pose truth = random_pose(random, i);
    Pose estimate = truth;
    estimate.translation() += 0.2 * random_pose(random, 500 + i).translation();
    pairs.emplace_back(estimate, truth);
  }
  const auto cost = [&](const Pose& X) {
    double sum = 0.0;
    for (const auto& [estimate, truth] : pairs) sum += (X * estimate.translation() - truth.translation()).squaredNorm();
    return sum;
  };
  const Pose best = align_trajectory(pairs);
  for (std::uint64_t i = 0; i < 200; ++i) {
    Pose step = random_pose(random, 2000 + i);
    step.linear() =
        rotation_from_rpy(0.01 * random.normal(9000 + 3 * i), 0.01 * random.normal(9001 + 3 * i), 0.01 * random.normal(9002 + 3 * i));
    step.translation() *= 0.01;
    EXPECT_LE(cost(best), cost(step * best));
  }
}

TEST(TrajectoryScore, AlignsWithARotationNotAReflection) {
  // Mirrored in z: the best orthogonal matrix would be a reflection.
  const RandomStream random(5, "alignment", "mirror");
  Pairs pairs;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Pose truth = random_pose(random, i);
    Pose estimate = truth;
    estimate.translation().z() *= -1.0;
    pairs.emplace_back(estimate, truth);
  }
  EXPECT_NEAR(align_trajectory(pairs).linear().determinant(), 1.0, 1e-9);
}

TEST(TrajectoryScore, PairsPosesByStamp) {
  Trajectory estimate, truth;
  estimate.poses = {{from_seconds(1.001), make_upright_pose(1, 0, 0, 0)}, {from_seconds(5.0), make_upright_pose(5, 0, 0, 0)}};
  truth.poses = {{0, make_upright_pose(0, 0, 0, 0)},
                 {from_seconds(0.995), make_upright_pose(9, 0, 0, 0)},
                 {from_seconds(1.0), make_upright_pose(1, 0, 0, 0)}};
  const Pairs pairs = associate_poses(estimate, truth);
  ASSERT_EQ(pairs.size(), 1u) << "5 s has no partner";
  EXPECT_EQ(pairs[0].second.translation().x(), 1.0);
  const Pairs swapped = associate_poses(truth, estimate);
  ASSERT_EQ(swapped.size(), 1u) << "the shorter list chooses";
  EXPECT_EQ(swapped[0].first.translation().x(), 1.0);
  estimate.poses.erase(estimate.poses.begin());
  EXPECT_THROW(associate_poses(estimate, truth), Error);
}

TEST(TrajectoryScore, PairsRowsWithoutStamps) {
  Trajectory estimate, truth;
  estimate.has_stamps = truth.has_stamps = false;
  estimate.poses.resize(3);
  truth.poses.resize(2);
  EXPECT_THROW(associate_poses(estimate, truth), Error);
  truth.poses.resize(3);
  EXPECT_EQ(associate_poses(estimate, truth).size(), 3u);
}

// The TUM RGB-D benchmark's evaluate_ate.py prints rmse 0.013473 m for this pair of files (stamps within 20 ms, each used once).
TEST(TrajectoryScore, AgreesWithTheTumBenchmarkOnFr1Xyz) {
  WARETWIN_NEED_DATA("trajectories");
  const Trajectory estimate = read_trajectory(test::shared_data("trajectories/freiburg1_xyz-rgbdslam.txt"));
  const Trajectory truth = read_trajectory(test::shared_data("trajectories/freiburg1_xyz-groundtruth.txt"));
  const TrajectoryScore score = score_trajectory(associate_poses(estimate, truth, from_seconds(0.02)), TrajectoryAlignment::kSe3);
  EXPECT_NEAR(score.ate_rmse_m, 0.013473, 1e-4);
  EXPECT_GT(score.pairs, 780);
}

}  // namespace
}  // namespace waretwin
