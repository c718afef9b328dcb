#include "core/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/cpu_features.h"
#include "core/random.h"
#include "core/version.h"
#include "tests/support/expect_error.h"

namespace waretwin {
namespace {

TEST(Statistics, ClosedForms) {
  EXPECT_EQ(mean({1, 2, 6}), 3.0);
  EXPECT_DOUBLE_EQ(rmse({3, -4}), std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(standard_deviation({1, 3}), std::sqrt(2.0));
  EXPECT_EQ(median({5, 1, 3}), 3.0);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(percentile({10, 20, 30, 40, 50}, 0), 10.0);
  EXPECT_EQ(percentile({50, 20, 30, 40, 10}, 100), 50.0);
  EXPECT_DOUBLE_EQ(percentile({10, 20, 30, 40, 50}, 95), 48.0);
  EXPECT_EQ(percentile({7}, 33), 7.0);
}

TEST(Statistics, OfNothingIsZero) {
  for (const double value : {mean({}), rmse({}), standard_deviation({}), standard_deviation({3}), median({}), percentile({}, 95)}) {
    EXPECT_EQ(value, 0.0);
  }
}

TEST(Statistics, PercentileAgreesWithSorting) {
  const RandomStream random(1, "test", "percentile");
  for (std::uint64_t round = 0; round < 200; ++round) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 1 + round % 40; ++i) values.push_back(std::floor(10 * random.uniform(round * 100 + i)));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const double percent = 100 * random.uniform(round, 1);
    const double place = percent / 100 * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    const double expected = sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
    EXPECT_NEAR(percentile(values, percent), expected, 1e-12);
  }
}

TEST(Statistics, ImpossiblePercentagesAreRefused) {
  EXPECT_ERROR(percentile({1}, -1), "expected 0 to 100");
  EXPECT_ERROR(percentile({1}, 101), "expected 0 to 100");
  EXPECT_ERROR(percentile({1}, std::nan("")), "expected 0 to 100");
}

TEST(Build, KnowsItsVersionAndCpu) {
  const std::string version = kVersion;
  EXPECT_EQ(std::count(version.begin(), version.end(), '.'), 2) << version;
  EXPECT_FALSE(cpu_model().empty());
#if defined(__x86_64__)
  const auto features = cpu_features();
  EXPECT_NE(std::find(features.begin(), features.end(), "sse2"), features.end());
#endif
}

}  // namespace
}  // namespace waretwin
