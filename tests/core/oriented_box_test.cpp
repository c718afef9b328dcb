#include "core/oriented_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "core/cuboid.h"
#include "core/random.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

constexpr double kPi = std::numbers::pi;

OrientedBox box(const Eigen::Vector3d& centre, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& size) {
  OrientedBox out;
  out.X_AO.linear() = rotation;
  out.X_AO.translation() = centre;
  out.size = size;
  return out;
}

Pose random_pose(const RandomStream& random, std::uint64_t index) {
  Eigen::Quaterniond q(random.normal(index, 0), random.normal(index, 1), random.normal(index, 2), random.normal(index, 3));
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(random.uniform(index, 4) - 0.5, random.uniform(index, 5) - 0.5, random.uniform(index, 6) - 0.5);
  return pose;
}

OrientedBox random_box(const RandomStream& random, std::uint64_t index) {
  OrientedBox out;
  out.X_AO = random_pose(random, index);
  out.size = {0.2 + random.uniform(index, 7), 0.2 + random.uniform(index, 8), 0.2 + random.uniform(index, 9)};
  return out;
}

std::array<Eigen::Vector3d, 8> corners_of(const OrientedBox& b) {
  std::array<Eigen::Vector3d, 8> out;
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d unit(i & 4 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 1 ? 0.5 : -0.5);
    out[i] = b.X_AO * unit.cwiseProduct(b.size);
  }
  return out;
}

// The blocks of the table: a line "name dims...", then the numbers.
std::map<std::string, std::vector<double>> read_table(const std::filesystem::path& file) {
  std::map<std::string, std::vector<double>> blocks;
  std::ifstream in(file);
  std::string line, name;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    if (std::isalpha(static_cast<unsigned char>(line[0]))) {
      words >> name;
      continue;
    }
    double value = 0;
    while (words >> value) blocks[name].push_back(value);
  }
  return blocks;
}

std::vector<OrientedBox> boxes_from(const std::vector<double>& numbers) {
  std::vector<OrientedBox> out;
  for (std::size_t i = 0; i + 24 <= numbers.size(); i += 24) {
    std::array<Eigen::Vector3d, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) corners[k] = {numbers[i + 3 * k], numbers[i + 3 * k + 1], numbers[i + 3 * k + 2]};
    out.push_back(oriented_box_from_corners(corners));
  }
  return out;
}

TEST(OrientedBox, AgreesWithObjectronsTable) {
  WARETWIN_NEED_DATA("box_iou");
  const auto blocks = read_table(test::shared_data("box_iou") / "objectron_vectors.txt");
  const std::vector<OrientedBox> first = boxes_from(blocks.at("boxes1"));
  const std::vector<OrientedBox> second = boxes_from(blocks.at("boxes2"));
  ASSERT_EQ(first.size(), 5u);
  ASSERT_EQ(second.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_NEAR(intersection_volume(first[i], second[k]), blocks.at("vols").at(5 * i + k), 1e-4) << i << " " << k;
      EXPECT_NEAR(iou_3d(first[i], second[k]), blocks.at("ious").at(5 * i + k), 1e-4) << i << " " << k;
    }
  }
}

TEST(OrientedBox, ClosedForms) {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  const OrientedBox unit = box({0, 0, 0}, none, {1, 1, 1});
  EXPECT_NEAR(iou_3d(unit, unit), 1.0, 1e-12);
  EXPECT_NEAR(intersection_volume(unit, box({0.5, 0.5, 0.5}, none, {1, 1, 1})), 0.125, 1e-12);
  EXPECT_NEAR(intersection_volume(unit, box({0.1, 0, 0}, none, {0.2, 0.3, 0.4})), 0.024, 1e-12);
  EXPECT_NEAR(intersection_volume(unit, box({1, 0, 0}, none, {1, 1, 1})), 0.0, 1e-10);
  EXPECT_NEAR(intersection_volume(unit, box({1, 1, 1}, none, {1, 1, 1})), 0.0, 1e-10);
  EXPECT_EQ(intersection_volume(unit, box({5, 0, 0}, rotation_from_rpy(0.1, 0.2, 0.3), {1, 1, 1})), 0.0);
  EXPECT_EQ(iou_3d(unit, box({0, 0, 0}, none, {1, 1, 0})), 0.0);
  // Octagonal prisms along each axis.
  for (const Eigen::Matrix3d& turn :
       {rotation_from_rpy(kPi / 4, 0, 0), rotation_from_rpy(0, kPi / 4, 0), rotation_from_rpy(0, 0, kPi / 4)}) {
    EXPECT_NEAR(intersection_volume(unit, box({0, 0, 0}, turn, {1, 1, 1})), 2 * (std::sqrt(2.0) - 1), 1e-12);
  }
  // A thin slab across the cube's diagonal cuts a regular hexagon of area 3 sqrt(3) / 4.
  const Eigen::Matrix3d diagonal =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(1, 1, 1)).toRotationMatrix();
  EXPECT_NEAR(intersection_volume(unit, box({0, 0, 0}, diagonal, {9, 9, 1e-4})) / 1e-4, 3 * std::sqrt(3.0) / 4, 1e-6);
  // A corner cut off by a far larger box: a tetrahedron with three legs of sqrt(3) * t, where t is its height.
  const double t = 0.2;
  const OrientedBox cutter = box(Eigen::Vector3d(0.5, 0.5, 0.5) + Eigen::Vector3d(1, 1, 1).normalized() * (5 - t), diagonal, {10, 10, 10});
  EXPECT_NEAR(intersection_volume(unit, cutter), std::pow(std::sqrt(3.0) * t, 3) / 6, 1e-10);
}

TEST(OrientedBox, SymmetricInvariantAndOneWithItself) {
  const RandomStream random(1, "test", "oriented");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    OrientedBox a = random_box(random, 2 * i);
    OrientedBox b = random_box(random, 2 * i + 1);
    const double iou = iou_3d(a, b);
    EXPECT_NEAR(iou_3d(b, a), iou, 1e-10);
    EXPECT_NEAR(iou_3d(a, a), 1.0, 1e-10);
    const Pose motion = random_pose(random, 100000 + i);
    a.X_AO = motion * a.X_AO;
    b.X_AO = motion * b.X_AO;
    EXPECT_NEAR(iou_3d(a, b), iou, 1e-9);
    // The same solid described by other axes.
    OrientedBox renamed = a;
    renamed.X_AO.linear().col(0) = a.X_AO.linear().col(1);
    renamed.X_AO.linear().col(1) = a.X_AO.linear().col(2);
    renamed.X_AO.linear().col(2) = a.X_AO.linear().col(0);
    renamed.size = {a.size.y(), a.size.z(), a.size.x()};
    EXPECT_NEAR(iou_3d(a, renamed), 1.0, 1e-9);
  }
}

TEST(OrientedBox, AgreesWithUprightBoxes) {
  const RandomStream random(2, "test", "upright");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Cuboid cuboids[2];
    OrientedBox boxes[2];
    for (std::uint64_t k = 0; k < 2; ++k) {
      const auto u = [&](std::uint32_t draw) { return random.uniform(2 * i + k, draw); };
      // Every fourth pair is aligned with the axes on a coarse grid, so that faces coincide.
      const bool grid = i % 4 == 0;
      const auto snap = [&](double v) { return grid ? std::round(v * 4) / 4 : v; };
      cuboids[k].centre = {snap(u(0)), snap(u(1)), snap(u(2))};
      cuboids[k].yaw = grid ? kPi / 2 * std::floor(4 * u(3)) : 7 * u(3);
      cuboids[k].size = {snap(0.3 + u(4)), snap(0.3 + u(5)), snap(0.3 + u(6))};
      boxes[k].X_AO = cuboids[k].pose();
      boxes[k].size = cuboids[k].size;
    }
    EXPECT_NEAR(intersection_volume(boxes[0], boxes[1]), intersection_volume(cuboids[0], cuboids[1]), 1e-10) << i;
  }
}

TEST(OrientedBox, AgreesWithMonteCarlo) {
  const RandomStream random(3, "test", "boxes");
  constexpr int kSamples = 20000;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const OrientedBox a = random_box(random, 2 * i);
    const OrientedBox b = random_box(random, 2 * i + 1);
    const RandomStream points(4, "test", "points", static_cast<Stamp>(i));
    const Pose X_ba = b.X_AO.inverse() * a.X_AO;
    int hits = 0;
    for (std::uint64_t k = 0; k < kSamples; ++k) {
      const Eigen::Vector3d unit(points.uniform(k, 0) - 0.5, points.uniform(k, 1) - 0.5, points.uniform(k, 2) - 0.5);
      const Eigen::Vector3d p = X_ba * unit.cwiseProduct(a.size);
      hits += (p.cwiseAbs() - 0.5 * b.size).maxCoeff() <= 0;
    }
    const double share = intersection_volume(a, b) / a.size.prod();
    const double tolerance = 5.0 * std::sqrt(std::max(share * (1 - share), 1e-4) / kSamples);
    EXPECT_NEAR(static_cast<double>(hits) / kSamples, share, tolerance) << i;
  }
}

TEST(OrientedBox, CornersGiveTheBoxBack) {
  const RandomStream random(5, "test", "corners");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const OrientedBox truth = random_box(random, i);
    auto corners = corners_of(truth);
    const OrientedBox found = oriented_box_from_corners(corners);
    EXPECT_LT((found.X_AO.matrix() - truth.X_AO.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((found.size - truth.size).norm(), 1e-12);
    // Seen in a mirror the corners are left-handed; the box has a right-handed frame all the same.
    for (Eigen::Vector3d& corner : corners) corner.x() *= -1;
    const OrientedBox mirrored = oriented_box_from_corners(corners);
    EXPECT_NEAR(mirrored.X_AO.linear().determinant(), 1.0, 1e-12);
    EXPECT_NEAR(intersection_volume(mirrored, mirrored), truth.size.prod(), 1e-10);
  }
}

TEST(OrientedBox, RefusesCornersThatAreNoBox) {
  auto corners = corners_of(box({0, 0, 0}, Eigen::Matrix3d::Identity(), {1, 2, 3}));
  auto moved = corners;
  moved[5].x() += 0.1;
  EXPECT_ERROR(oriented_box_from_corners(moved), "corner", "parallelepiped");
  auto sheared = corners;
  for (Eigen::Vector3d& corner : sheared) corner.x() += 0.1 * corner.z();
  EXPECT_ERROR(oriented_box_from_corners(sheared), "right angles");
  corners[0].x() = std::nan("");
  EXPECT_ERROR(oriented_box_from_corners(corners), "finite");
}

TEST(OrientedBox, FlatBoxesHaveAFrame) {
  const OrientedBox flat = oriented_box_from_corners(corners_of(box({1, 2, 3}, rotation_from_rpy(0.3, 0.2, 0.1), {1, 2, 0})));
  EXPECT_NEAR(flat.X_AO.linear().determinant(), 1.0, 1e-12);
  EXPECT_NEAR(flat.size.z(), 0.0, 1e-12);
  EXPECT_EQ(iou_3d(flat, flat), 0.0);
}

}  // namespace
}  // namespace waretwin
