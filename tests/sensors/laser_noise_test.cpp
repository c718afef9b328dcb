#include "sensors/laser_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

LaserScan scan_at(double range, Stamp stamp, std::size_t beams = 541) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.sensor = "laser";
  scan.ranges.assign(beams, static_cast<float>(range));
  return scan;
}

std::vector<double> errors(const LaserNoiseModel& model, double range, Stamp first, int scans) {
  std::vector<double> out;
  for (int i = 0; i < scans; ++i) {
    LaserScan scan = scan_at(range, first + i);
    model.apply(scan);
    for (const float r : scan.ranges) out.push_back(static_cast<double>(r) - range);
  }
  return out;
}

TEST(LaserNoise, RandomAndSystematicPartAreAsDeclared) {
  const LaserConfig laser;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const LaserNoiseModel model(laser, seed, "laser");
    const std::vector<double> e = errors(model, 4.0, 100, 200);
    EXPECT_LE(std::abs(model.bias_m()), laser.noise.bias_max_m);
    // Output steps of 10 mm: Sheppard's correction holds from half a step of deviation upwards to a few percent of a step squared.
    const double variance = laser.noise.sigma_m * laser.noise.sigma_m + laser.range_step_m * laser.range_step_m / 12;
    EXPECT_NEAR(test::sample_variance(e) / variance, 1.0, 0.03) << seed;
    EXPECT_NEAR(test::sample_mean(e), model.bias_m(), 3 * std::sqrt(variance / static_cast<double>(e.size())) + 1e-4) << seed;
  }
}

TEST(LaserNoise, WithoutStepsTheErrorIsNormal) {
  LaserConfig laser;
  laser.range_step_m = 0.0;
  const LaserNoiseModel model(laser, 3, "laser");
  std::vector<double> e = errors(model, 8.0, 0, 200);
  const double ratio = test::sample_variance(e) / (laser.noise.sigma_m * laser.noise.sigma_m);
  EXPECT_GT(ratio, test::variance_ratio_low(e.size()));
  EXPECT_LT(ratio, test::variance_ratio_high(e.size()));
  for (double& v : e) v = (v - model.bias_m()) / laser.noise.sigma_m;
  EXPECT_LT(test::ks_distance(e, test::normal_cdf), 1.63 / std::sqrt(static_cast<double>(e.size())));
}

TEST(LaserNoise, BiasIsUniformOverRunsAndConstantWithinOne) {
  const LaserConfig laser;
  std::vector<double> biases;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) biases.push_back(LaserNoiseModel(laser, seed, "laser").bias_m());
  const double range = laser.noise.bias_max_m;
  EXPECT_LT(test::ks_distance(biases, [&](double x) { return (x + range) / (2 * range); }), 1.63 / std::sqrt(2000.0));
  EXPECT_EQ(LaserNoiseModel(laser, 5, "laser").bias_m(), LaserNoiseModel(laser, 5, "laser").bias_m());
  EXPECT_NE(LaserNoiseModel(laser, 5, "laser").bias_m(), LaserNoiseModel(laser, 5, "laser2").bias_m());
  // Early and late scans of a run share it.
  const LaserNoiseModel model(laser, 5, "laser");
  EXPECT_NEAR(test::sample_mean(errors(model, 4.0, 0, 100)), test::sample_mean(errors(model, 4.0, 1'000'000'000'000, 100)), 3e-4);
}

TEST(LaserNoise, AScanDependsOnItsStampNotOnTheRate) {
  const LaserConfig laser;
  const LaserNoiseModel often(laser, 1, "laser");
  const LaserNoiseModel seldom(laser, 1, "laser");
  for (Stamp stamp = 0; stamp < 10; ++stamp) {
    LaserScan scan = scan_at(5.0, stamp);
    often.apply(scan);
    if (stamp % 3 != 0) continue;
    LaserScan same = scan_at(5.0, stamp);
    seldom.apply(same);
    EXPECT_EQ(scan.ranges, same.ranges);
  }
  LaserScan a = scan_at(5.0, 1);
  LaserScan b = scan_at(5.0, 2);
  often.apply(a);
  often.apply(b);
  EXPECT_NE(a.ranges, b.ranges);
}

TEST(LaserNoise, LimitsAndStepsHoldWithAndWithoutNoise) {
  LaserConfig laser;
  laser.noise.enabled = false;
  const LaserNoiseModel exact(laser, 1, "laser");
  LaserScan scan;
  scan.ranges = {0.0f, 0.04f, 0.05f, 1.234f, 1.236f, 30.0f, 30.01f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity()};
  exact.apply(scan);
  EXPECT_EQ(scan.ranges, (std::vector<float>{0, 0, 0.05f, 1.23f, 1.24f, 30.0f, 0, 0, 0, 0}));

  const LaserNoiseModel noisy(LaserConfig{}, 1, "laser");
  LaserScan far = scan_at(29.99, 0, 5000);
  noisy.apply(far);
  int none = 0;
  for (const float r : far.ranges) {
    EXPECT_LE(r, 30.0f);
    none += r == 0.0f;
    EXPECT_NEAR(std::nearbyint(r * 100.0), r * 100.0, 1e-4);
  }
  EXPECT_GT(none + 0.0, 0.0);
}

}  // namespace
}  // namespace waretwin
