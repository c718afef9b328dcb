#include "harness/score/trajectory_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

// Poses at 0, 1, 2 .. s.
Trajectory trajectory(const std::vector<Pose>& poses) {
  Trajectory result;
  for (std::size_t i = 0; i < poses.size(); ++i) result.poses.push_back({from_seconds(static_cast<double>(i)), poses[i]});
  return result;
}

// 1 m a second along x; the estimate takes every step 10 % too long and turns by 2 deg a step too much.
std::vector<Pose> straight(int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) poses.push_back(make_upright_pose(i, 0, 0, 0));
  return poses;
}

std::vector<Pose> drifting(int count) {
  std::vector<Pose> poses = {Pose::Identity()};
  while (static_cast<int>(poses.size()) < count) poses.push_back(poses.back() * make_upright_pose(1.1, 0, 0, to_radians(2.0)));
  return poses;
}

TEST(TrajectoryComparison, MeasuresDriftOverFramesInClosedForm) {
  TrajectoryRules rules;
  const TrajectoryComparison steps = compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules);
  EXPECT_EQ(steps.rpe_pairs, 10);
  EXPECT_NEAR(steps.rpe_trans_m->rmse, 0.1, 1e-9);
  EXPECT_NEAR(steps.rpe_rot_deg->rmse, 2.0, 1e-9);
  EXPECT_NEAR(steps.rpe_rot_deg->std, 0.0, 1e-6);
  rules.rpe_delta = 2;
  const TrajectoryComparison doubled = compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules);
  EXPECT_EQ(doubled.rpe_pairs, 5);
  // Two steps lead to 1.1 m + 1.1 m turned by 2 deg, where 2 m straight on are true.
  const double turn = to_radians(2.0);
  const double off = std::hypot(1.1 + 1.1 * std::cos(turn) - 2.0, 1.1 * std::sin(turn));
  EXPECT_NEAR(doubled.rpe_trans_m->rmse, off, 1e-9);
  EXPECT_NEAR(doubled.rpe_rot_deg->rmse, 4.0, 1e-9);
  rules.rpe_pairs = "all";
  EXPECT_EQ(compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules).rpe_pairs, 9);
}

TEST(TrajectoryComparison, MeasuresBySecondsAndByEitherOnesMetres) {
  TrajectoryRules rules;
  rules.rpe_pairs = "all";
  rules.rpe_delta = 3;
  rules.rpe_unit = "seconds";
  EXPECT_EQ(compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules).rpe_pairs, 8);
  rules.rpe_unit = "metres";
  rules.rpe_tolerance = 0.01;
  rules.rpe_from = "truth";
  EXPECT_EQ(compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules).rpe_pairs, 8);
  rules.rpe_delta = 3.3;
  rules.rpe_from = "estimate";
  EXPECT_EQ(compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules).rpe_pairs, 8);
  rules.rpe_from = "truth";
  EXPECT_THROW(compare_trajectories(trajectory(drifting(11)), trajectory(straight(11)), rules), Error);
}

TEST(TrajectoryComparison, SumsUpPositionErrors) {
  // Errors of 1, 2, 3 and 6 m, not aligned.
  const std::vector<Pose> truth = straight(4);
  std::vector<Pose> estimate = truth;
  const std::vector<double> errors = {1, 2, 3, 6};
  for (std::size_t i = 0; i < errors.size(); ++i) estimate[i].translation().z() += errors[i];
  TrajectoryRules rules;
  rules.alignment = "none";
  const TrajectoryComparison result = compare_trajectories(trajectory(estimate), trajectory(truth), rules);
  EXPECT_NEAR(result.ate_m.rmse, std::sqrt(50.0 / 4.0), 1e-12);
  EXPECT_NEAR(result.ate_m.mean, 3.0, 1e-12);
  EXPECT_NEAR(result.ate_m.median, 2.5, 1e-12);
  EXPECT_NEAR(result.ate_m.std, std::sqrt((4.0 + 1.0 + 0.0 + 9.0) / 4.0), 1e-12) << "divisor n";
  EXPECT_NEAR(result.ate_m.min, 1.0, 1e-12);
  EXPECT_NEAR(result.ate_m.max, 6.0, 1e-12);
  EXPECT_LT(result.ate_aligned_m.rmse, result.ate_m.rmse);
  rules.alignment = "se3";
  EXPECT_EQ(compare_trajectories(trajectory(estimate), trajectory(truth), rules).ate_m.rmse, result.ate_aligned_m.rmse);
}

TEST(TrajectoryComparison, ShiftsTheEstimatesStamps) {
  Trajectory late = trajectory(straight(5));
  for (StampedPose& pose : late.poses) pose.stamp += from_seconds(100.0);
  TrajectoryRules rules;
  EXPECT_THROW(compare_trajectories(late, trajectory(straight(5)), rules), Error);
  rules.time_offset_s = -100.0;
  EXPECT_NEAR(compare_trajectories(late, trajectory(straight(5)), rules).ate_plain_m.max, 0.0, 1e-12);
  const TrajectoryComparison shorter_truth = compare_trajectories(late, trajectory(straight(4)), rules);
  EXPECT_EQ(shorter_truth.matched_poses, 4);
  EXPECT_NEAR(shorter_truth.ate_plain_m.max, 0.0, 1e-12);
  // Off by a whole step, within a wide window: each pose meets its neighbour, 1 m away.
  rules.time_offset_s = -99.0;
  EXPECT_NEAR(compare_trajectories(late, trajectory(straight(6)), rules).ate_plain_m.max, 1.0, 1e-12);
}

TEST(TrajectoryComparison, OfOnePoseHasNoRelativeError) {
  const TrajectoryComparison one = compare_trajectories(trajectory(straight(1)), trajectory(straight(3)), {});
  EXPECT_EQ(one.matched_poses, 1);
  EXPECT_FALSE(one.rpe_trans_m.has_value());
  EXPECT_TRUE(nlohmann::json::parse(score_json(one))["trajectory"]["rpe_trans_m"].is_null());
}

TEST(TrajectoryComparison, NeedsStampsForSeconds) {
  Trajectory kitti = trajectory(straight(5));
  kitti.has_stamps = false;
  TrajectoryRules rules;
  rules.rpe_unit = "seconds";
  EXPECT_THROW(compare_trajectories(kitti, kitti, rules), Error);
  rules.rpe_unit = "frames";
  EXPECT_THROW(compare_trajectories(kitti, trajectory(straight(5)), rules), Error) << "rows cannot be matched with stamps";
  rules.rpe_unit = "metres";
  EXPECT_NEAR(compare_trajectories(kitti, kitti, rules).rpe_trans_m->max, 0.0, 1e-12);
}

TEST(TrajectoryComparison, SaysWhatItWasComputedWith) {
  TrajectoryRules rules;
  rules.rpe_delta = 2;
  const auto json = nlohmann::json::parse(score_json(compare_trajectories(trajectory(drifting(6)), trajectory(straight(8)), rules)));
  const auto& t = json["trajectory"];
  for (const char* key : {"ate_rmse_m", "ate_max_m", "ate_mean_m", "ate_median_m", "ate_std_m", "ate_min_m", "rpe_trans_m", "rpe_rot_deg",
                          "ate_unaligned_rmse_m", "ate_unaligned_max_m", "ate_aligned_rmse_m", "ate_aligned_max_m"}) {
    EXPECT_TRUE(t[key].is_number()) << key;
  }
  EXPECT_EQ(t["alignment"], "se3");
  EXPECT_EQ(t["poses"], 6);
  EXPECT_EQ(t["poses_truth"], 8);
  EXPECT_EQ(t["rpe"]["pairs"], 2);
  EXPECT_EQ(t["rpe"]["trans_m"]["rmse"], t["rpe_trans_m"]);
  EXPECT_EQ(t["rpe"]["rot_deg"]["rmse"], t["rpe_rot_deg"]);
  const nlohmann::json settings = {{"alignment", "se3"},   {"max_time_difference_s", 0.01}, {"time_offset_s", 0.0},
                                   {"rpe_delta", 2.0},     {"rpe_unit", "frames"},          {"rpe_pairs", "consecutive"},
                                   {"rpe_tolerance", 0.1}, {"rpe_from", "estimate"}};
  EXPECT_EQ(t["settings"], settings);
}

// The run's own score and this one are two ways through the same figures.
TEST(TrajectoryComparison, AgreesWithTheScoreOfARun) {
  const RandomStream random(6, "trajectory", "noise");
  std::vector<Pose> estimate = straight(40);
  for (std::uint64_t i = 0; i < estimate.size(); ++i) {
    estimate[i] = estimate[i] * make_upright_pose(0.1 * random.normal(4 * i), 0.1 * random.normal(4 * i + 1),
                                                  0.1 * random.normal(4 * i + 2), 0.1 * random.normal(4 * i + 3));
  }
  const TrajectoryComparison full = compare_trajectories(trajectory(estimate), trajectory(straight(40)), {});
  const auto pairs = associate_poses(trajectory(estimate), trajectory(straight(40)));
  const TrajectoryScore plain = score_trajectory(pairs, TrajectoryAlignment::kNone);
  EXPECT_NEAR(full.ate_plain_m.rmse, plain.ate_rmse_m, 1e-12);
  EXPECT_NEAR(full.ate_plain_m.max, plain.ate_max_m, 1e-12);
  EXPECT_NEAR(full.ate_aligned_m.rmse, score_trajectory(pairs, TrajectoryAlignment::kSe3).ate_rmse_m, 1e-12);
  EXPECT_NEAR(full.rpe_trans_m->rmse, plain.rpe_trans_m, 1e-12);
  EXPECT_NEAR(full.rpe_rot_deg->rmse, plain.rpe_rot_deg, 1e-9);
}

// RPE of 4x4 matrices multiplied out, the angle from the trace, for a given list of pairs.
struct SlowFigures {
  double trans_m = 0.0, rot_deg = 0.0;
};

SlowFigures slow_rpe(const std::vector<std::pair<Pose, Pose>>& matched, std::size_t delta) {
  double translations = 0.0, rotations = 0.0;
  for (std::size_t i = 0; i + delta < matched.size(); ++i) {
    const Eigen::Matrix4d P = matched[i].first.matrix().inverse() * matched[i + delta].first.matrix();
    const Eigen::Matrix4d Q = matched[i].second.matrix().inverse() * matched[i + delta].second.matrix();
    const Eigen::Matrix4d E = Q.inverse() * P;
    translations += E.topRightCorner<3, 1>().squaredNorm();
    const double angle = std::acos(std::clamp((E.topLeftCorner<3, 3>().trace() - 1.0) / 2.0, -1.0, 1.0));
    rotations += angle * angle;
  }
  const auto count = static_cast<double>(matched.size() - delta);
  return {std::sqrt(translations / count), to_degrees(std::sqrt(rotations / count))};
}

class Freiburg1Xyz : public testing::Test {
 protected:
  void SetUp() override {
    WARETWIN_NEED_DATA("trajectories");
    estimate_ = read_trajectory(test::shared_data("trajectories/freiburg1_xyz-rgbdslam.txt"));
    truth_ = read_trajectory(test::shared_data("trajectories/freiburg1_xyz-groundtruth.txt"));
  }
  TrajectoryComparison compare(const std::string& unit, double delta, const std::string& pairs, const std::string& from = "estimate") {
    TrajectoryRules rules;
    rules.rpe_unit = unit;
    rules.rpe_delta = delta;
    rules.rpe_pairs = pairs;
    rules.rpe_from = from;
    return compare_trajectories(estimate_, truth_, rules);
  }
  void expect_rpe(const TrajectoryComparison& comparison, int pairs, double trans_m, double rot_deg) {
    EXPECT_EQ(comparison.rpe_pairs, pairs);
    EXPECT_NEAR(comparison.rpe_trans_m->rmse, trans_m, 1e-6);
    EXPECT_NEAR(comparison.rpe_rot_deg->rmse, rot_deg, 1e-5);
  }
  Trajectory estimate_, truth_;
};

TEST_F(Freiburg1Xyz, HasThePublishedAte) {
  const TrajectoryComparison comparison = compare("frames", 1, "consecutive");
  EXPECT_EQ(comparison.matched_poses, 785);
  EXPECT_NEAR(comparison.ate_m.rmse, 0.0134, 1e-4);
}

TEST_F(Freiburg1Xyz, AgreesWithMatricesMultipliedOut) {
  const auto matched = associate_poses(estimate_, truth_);
  for (const std::size_t delta : {1u, 10u, 100u}) {
    const TrajectoryComparison comparison = compare("frames", static_cast<double>(delta), "all");
    const SlowFigures slow = slow_rpe(matched, delta);
    EXPECT_EQ(comparison.rpe_pairs, 785 - static_cast<int>(delta));
    EXPECT_NEAR(comparison.rpe_trans_m->rmse, slow.trans_m, 1e-9) << delta;
    EXPECT_NEAR(comparison.rpe_rot_deg->rmse, slow.rot_deg, 1e-6) << delta;
  }
}

// Figures of evo's definitions written down a second time, in Python.
TEST_F(Freiburg1Xyz, HasTheFiguresOfEvosDefinitions) {
  expect_rpe(compare("frames", 10, "consecutive"), 78, 0.0146101, 0.701571);
  expect_rpe(compare("metres", 1, "all"), 652, 0.0192999, 0.837774);
  expect_rpe(compare("metres", 1, "all", "truth"), 649, 0.0177372, 0.817709);
  expect_rpe(compare("metres", 1, "consecutive"), 7, 0.0226119, 1.108531);
  expect_rpe(compare("degrees", 10, "consecutive"), 44, 0.0179000, 0.757441);
  expect_rpe(compare("degrees", 10, "all"), 37553, 0.0214601, 0.961449);
  expect_rpe(compare("seconds", 1, "all"), 758, 0.0214911, 0.932581);
}

}  // namespace
}  // namespace waretwin
