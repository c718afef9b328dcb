#include "core/cuboid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tests/support/expect_error.h"

namespace waretwin {
namespace {

constexpr double kPi = std::numbers::pi;

Cuboid box(double x, double y, double z, double yaw, double dx, double dy, double dz) { return {{x, y, z}, yaw, {dx, dy, dz}, "world"}; }

Cuboid random_box(const RandomStream& random, std::uint64_t index) {
  const auto u = [&](std::uint32_t draw) { return random.uniform(index, draw); };
  return box(u(0) - 0.5, u(1) - 0.5, u(2) - 0.5, 2 * kPi * u(3), 0.2 + u(4), 0.2 + u(5), 0.2 + u(6));
}

bool inside(const Cuboid& cuboid, const Eigen::Vector3d& p) {
  const Eigen::Vector3d q = cuboid.pose().inverse() * p;
  return (q.cwiseAbs() - 0.5 * cuboid.size).maxCoeff() <= 0;
}

TEST(Cuboid, IouOfClosedForms) {
  const Cuboid unit = box(0, 0, 0, 0, 1, 1, 1);
  EXPECT_DOUBLE_EQ(iou_3d(unit, unit), 1.0);
  EXPECT_NEAR(iou_3d(unit, box(0.5, 0, 0, 0, 1, 1, 1)), 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(iou_3d(unit, box(0.5, 0.5, 0.5, 0, 1, 1, 1)), 0.125 / 1.875, 1e-15);
  // Two unit squares turned by 45 degrees share a regular octagon of area 2 (sqrt(2) - 1).
  const double octagon = 2.0 * (std::sqrt(2.0) - 1.0);
  EXPECT_NEAR(iou_3d(unit, box(0, 0, 0, kPi / 4, 1, 1, 1)), octagon / (2.0 - octagon), 1e-14);
  // Nested, a quarter turn of a long box, touching, apart.
  EXPECT_NEAR(iou_3d(unit, box(0.1, -0.1, 0.2, 0, 0.5, 0.4, 0.3)), 0.06, 1e-15);
  EXPECT_NEAR(iou_3d(box(0, 0, 0, 0, 2, 1, 1), box(0, 0, 0, kPi / 2, 2, 1, 1)), 1.0 / 3.0, 1e-14);
  EXPECT_EQ(iou_3d(unit, box(0, 0, 1, 0, 1, 1, 1)), 0.0);
  EXPECT_EQ(iou_3d(unit, box(1, 0, 0, 0, 1, 1, 1)), 0.0);
  EXPECT_EQ(iou_3d(unit, box(3, 3, 0, 0.3, 1, 1, 1)), 0.0);
}

TEST(Cuboid, IouOfEmptyBoxesIsZeroAndFramesMustAgree) {
  const Cuboid unit = box(0, 0, 0, 0, 1, 1, 1);
  const Cuboid flat = box(0, 0, 0, 0, 1, 1, 0);
  EXPECT_EQ(iou_3d(unit, flat), 0.0);
  EXPECT_EQ(iou_3d(flat, flat), 0.0);
  Cuboid elsewhere = unit;
  elsewhere.frame = "map";
  EXPECT_ERROR(iou_3d(unit, elsewhere), "'world'", "'map'");
}

TEST(Cuboid, IouIsSymmetricRigidInvariantAndBlindToHalfTurns) {
  const RandomStream random(1, "test", "pairs");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Cuboid a = random_box(random, 2 * i);
    const Cuboid b = random_box(random, 2 * i + 1);
    const double iou = iou_3d(a, b);
    EXPECT_NEAR(iou_3d(b, a), iou, 1e-12);
    EXPECT_NEAR(iou_3d(a, a), 1.0, 1e-12);
    const Pose X_AB = make_upright_pose(100 * random.uniform(i, 20), -50, 3, 7 * random.uniform(i, 21));
    EXPECT_NEAR(iou_3d(transformed(a, X_AB, "A"), transformed(b, X_AB, "A")), iou, 1e-11);
    EXPECT_NEAR(iou_3d(canonical(a), b), iou, 1e-12);
    Cuboid turned = a;
    turned.yaw += kPi;
    EXPECT_NEAR(iou_3d(turned, b), iou, 1e-12);
  }
}

TEST(Cuboid, IntersectionAgreesWithMonteCarlo) {
  const RandomStream random(2, "test", "boxes");
  constexpr int kSamples = 20000;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Cuboid a = random_box(random, 2 * i);
    const Cuboid b = random_box(random, 2 * i + 1);
    const RandomStream points(3, "test", "points", static_cast<Stamp>(i));
    int hits = 0;
    for (std::uint64_t k = 0; k < kSamples; ++k) {
      const Eigen::Vector3d unit(points.uniform(k, 0) - 0.5, points.uniform(k, 1) - 0.5, points.uniform(k, 2) - 0.5);
      hits += inside(b, a.pose() * unit.cwiseProduct(a.size));
    }
    const double share = intersection_volume(a, b) / a.volume();
    // Five standard deviations of a binomial share: all 20 hold with probability 0.99999.
    const double tolerance = 5.0 * std::sqrt(std::max(share * (1 - share), 1e-4) / kSamples);
    EXPECT_NEAR(static_cast<double>(hits) / kSamples, share, tolerance) << i;
  }
}

TEST(Cuboid, CanonicalFormKeepsTheBox) {
  const RandomStream random(4, "test", "canonical");
  for (std::uint64_t i = 0; i < 500; ++i) {
    Cuboid a = random_box(random, i);
    a.yaw = 40 * (random.uniform(i, 30) - 0.5);
    const Cuboid c = canonical(a);
    EXPECT_GE(c.size.x(), c.size.y());
    EXPECT_GE(c.yaw, 0.0);
    EXPECT_LT(c.yaw, kPi);
    EXPECT_NEAR(iou_3d(a, c), 1.0, 1e-12);
  }
  EXPECT_EQ(canonical(box(0, 0, 0, -1e-18, 2, 1, 1)).yaw, 0.0);
  EXPECT_FALSE(std::signbit(canonical(box(0, 0, 0, -0.0, 2, 1, 1)).yaw));
}

TEST(Cuboid, CornersFollowTheirBits) {
  const Cuboid a = box(1, 2, 3, kPi / 2, 4, 2, 6);
  const auto corners = a.corners();
  ASSERT_EQ(corners.size(), 8u);
  EXPECT_LT((corners[0] - Eigen::Vector3d(2, 0, 0)).norm(), 1e-14);
  EXPECT_LT((corners[1] - Eigen::Vector3d(2, 4, 0)).norm(), 1e-14);
  EXPECT_LT((corners[2] - Eigen::Vector3d(0, 0, 0)).norm(), 1e-14);
  EXPECT_LT((corners[4] - Eigen::Vector3d(2, 0, 6)).norm(), 1e-14);
}

// The slow reference: every hull edge by brute force over all pairs, and a dense sweep of headings, which can only be worse.
double area_at(const std::vector<Eigen::Vector3d>& points, double yaw) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d q(std::cos(yaw) * p.x() + std::sin(yaw) * p.y(), -std::sin(yaw) * p.x() + std::cos(yaw) * p.y());
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  return (high - low).prod();
}

TEST(MinimumAreaCuboid, AgreesWithBruteForceAndSweep) {
  const RandomStream random(5, "test", "clouds");
  for (std::uint64_t round = 0; round < 60; ++round) {
    std::vector<Eigen::Vector3d> points;
    const int count = 1 + static_cast<int>(round % 25);
    for (int i = 0; i < count; ++i) {
      const auto k = round * 1000 + static_cast<std::uint64_t>(i);
      points.emplace_back(1000 + 2 * random.normal(k, 0), random.normal(k, 1), random.uniform(k, 2));
    }
    const Cuboid result = minimum_area_cuboid(points);
    const double area = result.size.x() * result.size.y();
    EXPECT_NEAR(area_at(points, result.yaw), area, 1e-9);
    double best = std::numeric_limits<double>::infinity();
    for (const auto& p : points) {
      for (const auto& q : points) {
        if ((p - q).head<2>().norm() > 0) best = std::min(best, area_at(points, std::atan2(q.y() - p.y(), q.x() - p.x())));
      }
    }
    if (count >= 3) {
      EXPECT_NEAR(area, best, 1e-9) << round;
    }
    for (int step = 0; step < 1800; ++step) EXPECT_LE(area, area_at(points, step * kPi / 1800) + 1e-9);
    for (const auto& p : points) {
      Cuboid grown = result;
      grown.size.array() += 1e-9;
      EXPECT_TRUE(inside(grown, p));
    }
    EXPECT_GE(result.size.x(), result.size.y());
  }
}

TEST(MinimumAreaCuboid, FindsABoxFromItsCorners) {
  const RandomStream random(6, "test", "corners");
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Cuboid truth = canonical(random_box(random, i));
    const Cuboid found = minimum_area_cuboid(truth.corners(), "world");
    EXPECT_NEAR(iou_3d(truth, found), 1.0, 1e-9);
    EXPECT_LT(angle_distance(truth.yaw, found.yaw, kPi / 2), 1e-9);
  }
}

TEST(MinimumAreaCuboid, CirclesAndDegenerateClouds) {
  std::vector<Eigen::Vector3d> circle;
  for (int i = 0; i < 5000; ++i) circle.emplace_back(std::cos(i * 2 * kPi / 5000), std::sin(i * 2 * kPi / 5000), 0);
  const Cuboid around = minimum_area_cuboid(circle);
  EXPECT_NEAR(around.size.x(), 2.0, 1e-5);
  EXPECT_NEAR(around.size.y(), 2.0, 1e-5);
  EXPECT_LT(around.centre.norm(), 1e-6);

  const Cuboid point = minimum_area_cuboid({{1, 2, 3}, {1, 2, 3}});
  EXPECT_EQ(point.centre, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(point.size, Eigen::Vector3d::Zero());

  const Cuboid line = minimum_area_cuboid({{0, 0, 0}, {1, 1, 0}, {3, 3, 2}, {2, 2, 0}});
  EXPECT_NEAR(line.size.x(), 3 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(line.size.y(), 0.0, 1e-12);
  EXPECT_NEAR(line.yaw, kPi / 4, 1e-12);
  EXPECT_EQ(line.size.z(), 2.0);

  std::vector<Eigen::Vector3d> grid;
  for (int x = 0; x <= 10; ++x) {
    for (int y = 0; y <= 5; ++y) grid.emplace_back(0.1 * x, 0.1 * y, 0);
  }
  EXPECT_NEAR(minimum_area_cuboid(grid).size.x() * minimum_area_cuboid(grid).size.y(), 0.5, 1e-12);
}

TEST(MinimumAreaCuboid, RefusesNothingAndNan) {
  EXPECT_ERROR(minimum_area_cuboid({}), "no points");
  EXPECT_ERROR(minimum_area_cuboid({{0, 0, 0}, {std::nan(""), 0, 0}}), "not finite");
}

}  // namespace
}  // namespace waretwin
