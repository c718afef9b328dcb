#include "sensors/laser_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

// What the S300's data sheet promises up to 2 m, in each of 250 runs: the systematic part within +-20 mm and constant, 28 mm at one sigma
// with it, steps of 10 mm. Ranges are spread evenly, so that no step is favoured. All runs together hold at 95 % confidence: of 250 means
// one lies beyond 3.72 deviations by chance in 5 of 100 tests.
TEST(LaserNoise, EveryRunKeepsThePromisesOfTheDataSheet) {
  const LaserConfig laser;
  constexpr double kTogether = 3.72;
  std::vector<double> systematic;
  for (std::uint64_t seed = 1; seed <= 250; ++seed) {
    const LaserNoiseModel model(laser, seed, "laser");
    std::vector<double> halves[2], all;
    double square = 0.0;
    std::size_t within = 0;
    for (Stamp stamp = 0; stamp < 40; ++stamp) {
      LaserScan scan = scan_at(0.0, stamp * 40'000'000);
      std::vector<double> truth;
      for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
        truth.push_back(0.3 + 1.7 * std::fmod(0.6180339887 * static_cast<double>(i + 541 * static_cast<std::size_t>(stamp)), 1.0));
        scan.ranges[i] = static_cast<float>(truth.back());
      }
      model.apply(scan);
      for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
        const double reading = scan.ranges[i], error = reading - truth[i];
        ASSERT_NEAR(reading, std::nearbyint(100.0 * reading) / 100.0, 1e-6);
        halves[stamp / 20].push_back(error);
        all.push_back(error);
        square += error * error;
        within += std::abs(error) <= 0.028;
      }
    }
    const auto n = static_cast<double>(all.size());
    const double deviation = std::sqrt(test::sample_variance(all) / n);
    EXPECT_LE(std::abs(test::sample_mean(all)), 0.020 + kTogether * deviation) << seed;
    EXPECT_NEAR(test::sample_mean(halves[0]), test::sample_mean(halves[1]), kTogether * 2.0 * deviation) << seed;
    EXPECT_LE(std::sqrt(square / n), 0.028) << seed;
    const double share = static_cast<double>(within) / n;
    EXPECT_GE(share - kTogether * std::sqrt(share * (1.0 - share) / n), 0.6827) << seed;
    systematic.push_back(test::sample_mean(all));
  }
  // The runs use the whole of it.
  const auto [low, high] = std::minmax_element(systematic.begin(), systematic.end());
  EXPECT_LT(*low, -0.019);
  EXPECT_GT(*high, 0.019);
}

// Accuracy of the UTM-30LX: +-30 mm up to 10 m, +-50 mm up to 30 m, of which the repeated one (10 and 30 mm) is random; of the TiM571:
// +-60 mm and 20 mm at any range.
TEST(LaserNoise, OtherScannersErrByTheirOwnDataSheets) {
  struct Case {
    const char* preset;
    double range, sigma, accuracy;
  };
  for (const Case& c : {Case{"hokuyo_utm30lx", 2.0, 0.010, 0.030},
                        {"hokuyo_utm30lx", 9.9, 0.010, 0.030},
                        {"hokuyo_utm30lx", 20.0, 0.020, 0.050},
                        {"hokuyo_utm30lx", 29.8, 0.030, 0.050},
                        {"sick_tim571", 2.0, 0.020, 0.080},
                        {"sick_tim571", 24.5, 0.020, 0.080}}) {
    LaserConfig laser = LaserConfig::make(c.preset);
    EXPECT_NEAR(laser.noise.deviation(c.range, laser.range_max_m), c.sigma, 0.0004) << c.preset << " " << c.range;
    laser.range_max_m += 1.0;  // no reading is cut off
    laser.noise.sigma_far_m += (laser.noise.sigma_far_m - laser.noise.sigma_m) / 20.0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const LaserNoiseModel model(laser, seed, "laser");
      const std::vector<double> e = errors(model, c.range, 0, 20);
      const double sigma = laser.noise.deviation(c.range, laser.range_max_m);
      const double ratio = test::sample_variance(e) / (sigma * sigma + 1e-6 / 12.0);
      EXPECT_GT(ratio, test::chi_square_ratio(e.size(), -3.3)) << c.preset << " " << c.range;  // ten seeds, six cases: 95 % together
      EXPECT_LT(ratio, test::chi_square_ratio(e.size(), 3.3)) << c.preset << " " << c.range;
      const double slack = 3.3 * sigma / std::sqrt(static_cast<double>(e.size()));
      EXPECT_LE(std::abs(test::sample_mean(e)) + std::sqrt(test::sample_variance(e)), c.accuracy + 2.0 * slack)
          << c.preset << " " << c.range;
    }
  }
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
