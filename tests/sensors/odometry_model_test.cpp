#include "sensors/odometry_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

constexpr Stamp kStep = 20'000'000;

OdometryConfig exact() {
  OdometryConfig config;
  config.noise.enabled = false;
  return config;
}

// Drives straight ahead and then turns in place; returns the last reading.
OdometryReading drive(OdometryModel& model, double distance, double turn, int steps, Stamp step = kStep) {
  const Pose start = make_upright_pose(3, -2, 0, 0.7);
  Stamp stamp = 0;
  OdometryReading last = model.advance(stamp, start);
  for (int i = 1; i <= steps; ++i) last = model.advance(stamp += step, start * make_upright_pose(distance * i / steps, 0, 0, 0));
  if (turn == 0.0) return last;
  for (int i = 1; i <= steps; ++i) last = model.advance(stamp += step, start * make_upright_pose(distance, 0, 0, turn * i / steps));
  return last;
}

TEST(Odometry, WithoutNoiseItFollowsAnyWay) {
  OdometryModel model(exact(), 1, "odometry");
  const Pose X_WS = make_upright_pose(5, 6, 0, 2);
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.01 * i;
    const Pose X_SB = make_upright_pose(std::sin(t), 1 - std::cos(0.7 * t), 0, t);
    const OdometryReading reading = model.advance(i * kStep, X_WS * X_SB);
    EXPECT_EQ(reading.stamp, i * kStep);
    ASSERT_LT((reading.X_OB.matrix() - X_SB.matrix()).cwiseAbs().maxCoeff(), 2e-9);
  }
}

TEST(Odometry, FirstReadingIsTheOrigin) {
  OdometryModel model(OdometryConfig{}, 1, "odometry");
  EXPECT_EQ(model.advance(5, make_upright_pose(3, 4, 0, 1)).X_OB.matrix(), Pose::Identity().matrix());
}

TEST(Odometry, RandomWalkHasTheDeclaredSizeAtAnyRate) {
  OdometryConfig config;
  config.noise.distance_scale_sd = config.noise.turn_scale_sd = 0.0;
  constexpr int kRuns = 600;
  for (const int steps : {20, 100}) {
    std::vector<double> lengths;
    std::vector<double> headings;
    for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
      OdometryModel model(config, seed, "odometry");
      const Pose end = drive(model, 4.0, 0.0, steps).X_OB;
      lengths.push_back(end.translation().x());
      headings.push_back(yaw_of(end));
    }
    const double length_variance = 4.0 * config.noise.distance_sd_m * config.noise.distance_sd_m;
    const double heading_variance = 4.0 * config.noise.turn_sd_per_m_rad * config.noise.turn_sd_per_m_rad;
    EXPECT_GT(test::sample_variance(headings) / heading_variance, test::variance_ratio_low(kRuns));
    EXPECT_LT(test::sample_variance(headings) / heading_variance, test::variance_ratio_high(kRuns));
    EXPECT_GT(test::sample_variance(lengths) / length_variance, test::variance_ratio_low(kRuns));
    EXPECT_LT(test::sample_variance(lengths) / length_variance, test::variance_ratio_high(kRuns));
    EXPECT_LT(std::abs(test::sample_mean(headings)), 2.576 * std::sqrt(heading_variance / kRuns));
  }
}

TEST(Odometry, TurningInPlaceHasTheDeclaredError) {
  OdometryConfig config;
  config.noise.turn_scale_sd = 0.0;
  constexpr int kRuns = 600;
  std::vector<double> errors;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    OdometryModel model(config, seed, "odometry");
    errors.push_back(wrap_angle(yaw_of(drive(model, 0.0, 2.0, 50).X_OB) - 2.0));
  }
  const double ratio = test::sample_variance(errors) / (2.0 * config.noise.turn_sd_per_rad_rad * config.noise.turn_sd_per_rad_rad);
  EXPECT_GT(ratio, test::variance_ratio_low(kRuns));
  EXPECT_LT(ratio, test::variance_ratio_high(kRuns));
}

TEST(Odometry, ScaleErrorsStayForARunAndVaryBetweenRuns) {
  OdometryConfig config;
  config.noise.distance_sd_m = config.noise.turn_sd_per_m_rad = config.noise.turn_sd_per_rad_rad = 0.0;
  std::vector<double> distance_scales;
  std::vector<double> turn_scales;
  constexpr int kRuns = 1000;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    OdometryModel model(config, seed, "odometry");
    distance_scales.push_back((model.distance_scale() - 1.0) / config.noise.distance_scale_sd);
    turn_scales.push_back((model.turn_scale() - 1.0) / config.noise.turn_scale_sd);
    if (seed > 20) continue;
    const Pose end = drive(model, 3.0, 1.0, 30).X_OB;
    EXPECT_NEAR(end.translation().x(), 3.0 * model.distance_scale(), 2e-9);
    EXPECT_NEAR(yaw_of(end), model.turn_scale(), 2e-9);
  }
  EXPECT_LT(test::ks_distance(distance_scales, test::normal_cdf), 1.63 / std::sqrt(kRuns));
  EXPECT_LT(test::ks_distance(turn_scales, test::normal_cdf), 1.63 / std::sqrt(kRuns));
  EXPECT_LT(std::abs(test::correlation(distance_scales, turn_scales)), 3.3 / std::sqrt(kRuns));
}

TEST(Odometry, RunsRepeatAndSensorsDiffer) {
  OdometryModel a(OdometryConfig{}, 7, "odometry");
  OdometryModel b(OdometryConfig{}, 7, "odometry");
  OdometryModel other(OdometryConfig{}, 7, "wheels");
  const Pose end = drive(a, 2, 1, 40).X_OB;
  EXPECT_EQ(end.matrix(), drive(b, 2, 1, 40).X_OB.matrix());
  EXPECT_NE(end.matrix(), drive(other, 2, 1, 40).X_OB.matrix());
}

}  // namespace
}  // namespace waretwin
