#include "sim/spread_points.h"

#include <gtest/gtest.h>

#include <set>

namespace waretwin {
namespace {

TEST(SpreadPoints, EveryWindowOfATileHasEveryPointOnce) {
  const SpreadPoints points(7);
  for (const auto& [left, top] : {std::pair{0, 0}, std::pair{3, 5}, std::pair{-9, -2}, std::pair{1000, 717}}) {
    std::set<float> a, b, c;
    for (int y = top; y < top + SpreadPoints::kTile; ++y) {
      for (int x = left; x < left + SpreadPoints::kTile; ++x) {
        if (!SpreadPoints::looks_from(x, y)) continue;
        const SpreadPoint point = points.at(x, y);
        for (const float value : {point.a, point.b, point.c}) {
          EXPECT_GE(value, 0.0f);
          EXPECT_LT(value, 1.0f);
        }
        a.insert(point.a);
        b.insert(point.b);
        c.insert(point.c);
      }
    }
    // Evenly spread, wherever the first one is.
    for (const auto& values : {a, b, c}) {
      ASSERT_EQ(values.size(), 32u);
      for (auto value = values.begin(), next = std::next(value); next != values.end(); ++value, ++next)
        EXPECT_NEAR(*next - *value, 1.0f / 32, 1e-6f);
    }
  }
  EXPECT_NE(points.at(4, 4).a, SpreadPoints(8).at(4, 4).a);
}

// An edge cuts a filter's window: half of it must do.
TEST(SpreadPoints, PartsOfATileAreSpread) {
  const SpreadPoints points(7);
  for (int top = 0; top < 8; ++top) {
    double a = 0.0, b = 0.0, c = 0.0;
    for (int y = top; y < top + 4; ++y) {
      for (int x = 0; x < 8; ++x) {
        if (!SpreadPoints::looks_from(x, y)) continue;
        const SpreadPoint point = points.at(x, y);
        a += static_cast<double>(point.a) / 16;
        b += static_cast<double>(point.b) / 16;
        c += static_cast<double>(point.c) / 16;
      }
    }
    // Of 16 independent numbers the mean would be off by 0.07, and twice that now and then.
    for (const double mean : {a, b, c}) EXPECT_NEAR(mean, 0.5, 0.1) << top;
  }
}

}  // namespace
}  // namespace waretwin
