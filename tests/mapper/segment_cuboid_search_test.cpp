#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "core/pose.h"
#include "core/random.h"
#include "mapper/segment/cuboid_search.h"

namespace waretwin {
namespace {

std::vector<Eigen::Vector3f> random_points(std::uint64_t seed, int count) {
  const RandomStream random(seed, "points", "draw");
  const Pose X_WO = make_upright_pose(3 * random.uniform(0, 8), -2, 0.4, 6.28 * random.uniform(0, 9));
  std::vector<Eigen::Vector3f> points_W;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p_O(0.8 * random.uniform(i, 0), 0.4 * random.uniform(i, 1), 0.2 * random.uniform(i, 2));
    points_W.push_back((X_WO * p_O).cast<float>());
  }
  return points_W;
}

// Fig. 3 written out: every heading, every point.
double smallest_area(const std::vector<Eigen::Vector3f>& points_W, double step, int headings) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < headings; ++i) {
    const double c = std::cos(i * step), s = std::sin(i * step);
    double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
    for (const Eigen::Vector3f& p : points_W) {
      const double x = c * p.x() + s * p.y(), y = -s * p.x() + c * p.y();
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
    best = std::min(best, (x1 - x0) * (y1 - y0));
  }
  return best;
}

TEST(CuboidSearch, EqualsThePlainLoop) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto points_W = random_points(seed, 5 + 40 * static_cast<int>(seed));
    const Cuboid cuboid = search_cuboid(points_W, to_radians(1));
    EXPECT_NEAR(cuboid.size.x() * cuboid.size.y(), smallest_area(points_W, to_radians(1), 180), 1e-9);
    const Pose X_OW = cuboid.pose().inverse();
    for (const Eigen::Vector3f& p_W : points_W) {
      const Eigen::Vector3d outside = (X_OW * p_W.cast<double>()).cwiseAbs() - 0.5 * cuboid.size;
      EXPECT_LT(outside.maxCoeff(), 1e-6);
    }
  }
}

TEST(CuboidSearch, ComesNearTheExactRectangleByRotatingCalipers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto points_W = random_points(seed, 500);
    std::vector<Eigen::Vector3d> exact_points;
    for (const Eigen::Vector3f& p : points_W) exact_points.push_back(p.cast<double>());
    const Cuboid exact = minimum_area_cuboid(exact_points), found = search_cuboid(points_W, to_radians(1));
    // Half a degree off widens a side by the other's length times sin 0.5 deg at most.
    EXPECT_GE(found.volume(), exact.volume() * (1 - 1e-9));
    EXPECT_LE(found.volume(), exact.volume() * (1 + 0.03));
    EXPECT_LE(search_cuboid(points_W, to_radians(0.05)).volume(), exact.volume() * (1 + 0.002));
  }
}

TEST(CuboidSearch, IsExactForAnAlignedBoxAndSurvivesDegenerateClouds) {
  const Cuboid cuboid = search_cuboid({{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 3}}, to_radians(1));
  EXPECT_TRUE(cuboid.centre.isApprox(Eigen::Vector3d(1, 0.5, 2)));
  EXPECT_TRUE(cuboid.size.isApprox(Eigen::Vector3d(2, 1, 2)));
  EXPECT_EQ(cuboid.yaw, 0.0);
  EXPECT_EQ(search_cuboid({{1, 2, 3}}, 0.1).volume(), 0.0);
  EXPECT_EQ(search_cuboid({{1, 2, 3}, {1, 2, 3}, {2, 2, 3}}, 0.1).volume(), 0.0);
  EXPECT_THROW(search_cuboid({}, 0.1), Error);
  EXPECT_THROW(search_cuboid({{1, 2, 3}}, 0.0), Error);
}

}  // namespace
}  // namespace waretwin
