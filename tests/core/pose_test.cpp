#include "core/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "core/stamp.h"

namespace waretwin {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Pose, AnglesWrapIntoHalfOpenTurn) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3 * kPi + 0.1), -kPi + 0.1, 1e-14);
  for (double a = -50; a < 50; a += 0.37) {
    EXPECT_GT(wrap_angle(a), -kPi);
    EXPECT_LE(wrap_angle(a), kPi);
    EXPECT_NEAR(std::cos(wrap_angle(a)), std::cos(a), 1e-13);
    EXPECT_NEAR(std::sin(wrap_angle(a)), std::sin(a), 1e-13);
  }
}

TEST(Pose, AngleDistanceKnowsSymmetry) {
  EXPECT_NEAR(angle_distance(0.1, kPi + 0.2, kPi), 0.1, 1e-14);
  EXPECT_NEAR(angle_distance(0.1, kPi + 0.1, 2 * kPi), kPi, 1e-14);
  EXPECT_NEAR(angle_distance(-3.1, 3.1, 2 * kPi), 2 * kPi - 6.2, 1e-14);
  EXPECT_NEAR(angle_distance(0.0, kPi / 2, kPi / 2), 0.0, 1e-14);
}

TEST(Pose, UprightPoseAndYawAreInverse) {
  for (double yaw = -3; yaw < 3; yaw += 0.1) {
    const Pose pose = make_upright_pose(1, 2, 3, yaw);
    EXPECT_NEAR(yaw_of(pose), yaw, 1e-14);
    EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 3));
  }
}

TEST(Pose, RollPitchYawTurnInTheirOrder) {
  // Pitch down turns forward towards the floor; yaw then turns it to the left.
  const Eigen::Vector3d forward = rotation_from_rpy(0, kPi / 4, kPi / 2) * Eigen::Vector3d::UnitX();
  EXPECT_LT((forward - Eigen::Vector3d(0, std::sqrt(0.5), -std::sqrt(0.5))).norm(), 1e-15);
  EXPECT_LT((rotation_from_rpy(kPi / 2, 0, 0) * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(Pose, CameraAxesLookForward) {
  const Eigen::Matrix3d R_BC = optical_from_forward();
  EXPECT_EQ(R_BC * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX());
  EXPECT_EQ(R_BC * Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY());
  EXPECT_EQ(R_BC * Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(R_BC.determinant(), 1.0);
}

TEST(Pose, InterpolationIsEvenInAngleAndWay) {
  const Pose a = make_upright_pose(0, 0, 0, 0.2);
  const Pose b = make_upright_pose(4, 2, 0, 1.4);
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const Pose m = interpolate(a, b, t);
    EXPECT_NEAR(yaw_of(m), 0.2 + 1.2 * t, 1e-12);
    EXPECT_LT((m.translation() - t * b.translation()).norm(), 1e-12);
    EXPECT_NEAR(rotation_between(a, m), 1.2 * t, 1e-7);
  }
}

TEST(Pose, OrthonormalisingUndoesSmallDamage) {
  const RandomStream random(1, "test", "pose");
  for (std::uint64_t i = 0; i < 100; ++i) {
    Pose pose = make_upright_pose(1, 2, 3, 6 * random.uniform(i));
    Pose damaged = pose;
    for (int k = 0; k < 9; ++k) damaged.linear()(k / 3, k % 3) += 1e-4 * random.normal(i, static_cast<std::uint32_t>(k + 1));
    const Pose mended = orthonormalised(damaged);
    EXPECT_LT((mended.linear().transpose() * mended.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT(rotation_between(pose, mended), 1e-3);
    EXPECT_EQ(mended.translation(), pose.translation());
  }
}

TEST(Stamp, SecondsThereAndBack) {
  EXPECT_EQ(from_seconds(1.5), 1'500'000'000);
  EXPECT_EQ(from_seconds(-0.1), -100'000'000);
  EXPECT_EQ(to_seconds(250'000'000), 0.25);
}

}  // namespace
}  // namespace waretwin
