#include "sim/laser_scanner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

// From (x, y) along the angle to the walls of the rectangle [-3, 5] x [-2, 4].
double wall_distance(double x, double y, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  double distance = 1e9;
  if (c > 1e-12) distance = std::min(distance, (5 - x) / c);
  if (c < -1e-12) distance = std::min(distance, (-3 - x) / c);
  if (s > 1e-12) distance = std::min(distance, (4 - y) / s);
  if (s < -1e-12) distance = std::min(distance, (-2 - y) / s);
  return distance;
}

RayCaster room_caster() { return RayCaster(std::make_shared<const Scene>(fixtures::room(-3, 5, -2, 4, 3))); }

TEST(IdealScan, RectangularRoomFromAMovingRobot) {
  const RayCaster caster = room_caster();
  LaserConfig config = LaserConfig::make("ideal");
  // 1 m/s and 2 rad/s: within one turn of the mirror the vehicle moves by 30 mm and 3 deg.
  const auto x = [](double t) { return 0.5 + t; };
  const auto yaw = [](double t) { return 0.2 + 2.0 * t; };
  const auto X_WB = [&](Stamp stamp) { return make_upright_pose(x(to_seconds(stamp)), 0.3, 0, yaw(to_seconds(stamp))); };
  const Stamp start = from_seconds(1.0);
  const LaserScan scan = ideal_scan(caster, config, "laser", start, [&](Stamp at) { return X_WB(at) * config.mount.X_BL(); });
  ASSERT_EQ(scan.ranges.size(), 541u);
  EXPECT_EQ(scan.stamp, start);
  // 270 deg of a 40 ms turn.
  EXPECT_NEAR(to_seconds(540 * scan.beam_interval), 0.03, 1e-6);
  for (int i = 0; i < 541; ++i) {
    const double t = 1.0 + to_seconds(i * scan.beam_interval);
    const double mount_yaw = to_radians(43.9), c = std::cos(yaw(t)), s = std::sin(yaw(t));
    const double lx = x(t) + c * 0.275 - s * 0.2, ly = 0.3 + s * 0.275 + c * 0.2;
    const double angle = to_radians(-135 + 0.5 * i);
    const double expected = wall_distance(lx, ly, angle + mount_yaw + yaw(t));
    ASSERT_NEAR(scan.ranges[static_cast<std::size_t>(i)], expected, 1e-5 * expected) << i;
  }
}

TEST(IdealScan, LimitsOfTheScanner) {
  const RayCaster caster = room_caster();
  LaserConfig config = LaserConfig::make("ideal");
  config.mount = {.z_m = 0.3};
  config.range_min_m = 2.5;
  config.range_max_m = 4.0;
  const LaserScan scan = ideal_scan(caster, config, "laser", 0, [&](Stamp) { return config.mount.X_BL(); });
  int seen = 0;
  for (int i = 0; i < 541; ++i) {
    const double expected = wall_distance(0, 0, to_radians(-135 + 0.5 * i));
    const float range = scan.ranges[static_cast<std::size_t>(i)];
    if (expected < 2.499 || expected > 4.001) {
      EXPECT_EQ(range, 0.0f) << i;
    }
    if (expected > 2.501 && expected < 3.999) {
      EXPECT_NEAR(range, expected, 1e-4) << i;
      ++seen;
    }
  }
  EXPECT_GT(seen, 50);
}

}  // namespace
}  // namespace waretwin
