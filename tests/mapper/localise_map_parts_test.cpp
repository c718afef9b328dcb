// The parts of localisation against a local map: points of a scan, the search, the graph of keyframes.
#include <gtest/gtest.h>

#include "mapper/localise/keyframe_graph.h"
#include "mapper/localise/map_search.h"
#include "tests/mapper/planar_drive.h"

namespace waretwin {
namespace {

test::PlanarDrive standing(const PlanarMotion& X_WB) {
  test::PlanarDrive drive;
  drive.walls = test::hall();
  drive.pose = [X_WB](double) { return X_WB; };
  return drive;
}

std::vector<ScanPoint> points_at(const PlanarMotion& X_WB) {
  const test::PlanarDrive drive = standing(X_WB);
  return scan_points(drive.scan(0), drive.X_BL, {}, {}, ScanPointsConfig{});
}

double distance_from_walls(const std::vector<test::Wall>& walls, const Eigen::Vector2d& p_W) {
  double nearest = 100.0;
  for (const test::Wall& wall : walls) {
    const Eigen::Vector2d along = (wall.b - wall.a).normalized(), o = p_W - wall.a;
    const double at = std::clamp(along.dot(o), 0.0, (wall.b - wall.a).norm());
    nearest = std::min(nearest, (o - at * along).norm());
  }
  return nearest;
}

TEST(ScanPoints, LieOnWallsAndFaceTheLaser) {
  const PlanarMotion X_WB{{5.0, 3.0}, 0.4};
  const test::PlanarDrive drive = standing(X_WB);
  const std::vector<ScanPoint> points = points_at(X_WB);
  EXPECT_GT(points.size(), 450u);
  EXPECT_LT(points.size(), 541u) << "points at edges are left out";
  const Eigen::Vector2d p_WL = X_WB * drive.X_BL.translation().head<2>();
  int askew = 0;
  for (const ScanPoint& point : points) {
    const Eigen::Vector2d p_W = X_WB * point.p, n_W = X_WB.rotation() * point.normal, d_W = X_WB.rotation() * point.direction;
    EXPECT_LT(((p_W - p_WL).normalized() - d_W).norm(), 1e-9);
    EXPECT_LT(n_W.dot(d_W), 0.0);
    // All walls run along x or y.
    askew += n_W.cwiseAbs().maxCoeff() < std::cos(to_radians(8.0)) ? 1 : 0;
    EXPECT_LT(distance_from_walls(drive.walls, p_W), 1e-5);
  }
  EXPECT_LE(askew, 5) << "next to corners";
}

TEST(ScanPoints, AreBroughtToTheMiddleOfTheTurn) {
  test::PlanarDrive drive = standing({});
  const PlanarMotion start{{5.0, 3.0}, 0.4};
  const auto pose = [&](double t) { return start * PlanarMotion{{1.0 * t, 0.2 * t}, 1.0 * t}; };
  drive.pose = pose;
  const LaserScan scan = drive.scan(0);
  const double end = to_seconds(scan.beam_interval * 540);
  const PlanarMotion X_SM = pose(0.5 * end);
  const auto moved = scan_points(scan, drive.X_BL, X_SM.inverse() * pose(0.0), X_SM.inverse() * pose(end), ScanPointsConfig{});
  ScanPointsConfig off;
  off.deskew = false;
  const auto bent = scan_points(scan, drive.X_BL, X_SM.inverse() * pose(0.0), X_SM.inverse() * pose(end), off);
  const auto worst = [&](const std::vector<ScanPoint>& points) {
    double far = 0.0;
    for (const ScanPoint& point : points) far = std::max(far, distance_from_walls(drive.walls, X_SM * point.p));
    return far;
  };
  EXPECT_LT(worst(moved), 0.002);
  EXPECT_GT(worst(bent), 0.05) << "at 1 m/s and 1 rad/s walls bend";
}

// The slow way: all poses of the grid, all points, all cells.
TEST(MapSearch, FindsWhatLookingEverywhereFinds) {
  const PlanarMotion truth{{5.0, 3.0}, 0.4};
  LocalMap map(0.05);
  for (const double x : {4.0, 5.0, 6.0}) map.add(points_at({{x, 3.2}, 0.2}), {{x, 3.2}, 0.2}, 0.0, 0);
  map.finish();
  const std::vector<ScanPoint> points = points_at(truth);
  MapSearchConfig config;
  config.points = 100;
  for (const PlanarMotion& off : {PlanarMotion{{0.31, -0.22}, 0.2}, PlanarMotion{{-0.4, 0.4}, -0.15}}) {
    const SearchWindow window{{truth.translation + off.translation, truth.yaw + off.yaw}, 0.5, 15.0};
    const auto found = search_map(map, points, window, 0.0, config);
    ASSERT_TRUE(found);
    EXPECT_LT((found->X_SB.translation - truth.translation).norm(), 0.06);
    EXPECT_LT(std::abs(to_degrees(found->X_SB.yaw - truth.yaw)), 1.0);
    double best = 0.0;
    for (int turn = -15; turn <= 15; ++turn) {
      for (int x = -5; x <= 5; ++x) {
        for (int y = -5; y <= 5; ++y) {
          const PlanarMotion X{window.centre.translation + 0.1 * Eigen::Vector2d(x, y), window.centre.yaw + to_radians(turn)};
          best = std::max(best, pose_score(map, points, X, 0.0, config));
        }
      }
    }
    EXPECT_GT(pose_score(map, points, found->X_SB, 0.0, config), best - 0.05);
  }
  EXPECT_FALSE(search_map(map, points, {{{50.0, 50.0}, 0.0}, 1.0, 10.0}, 0.0, config)) << "nothing there";
  config.min_score = 1.0;
  EXPECT_FALSE(search_map(map, points, {truth, 0.2, 5.0}, 0.0, config)) << "nothing good enough";
  EXPECT_FALSE(search_map(LocalMap(0.05), points, {truth, 0.2, 5.0}, 0.0, config));
}

// Round a rectangle whose third side comes out shorter than the first: the loop shares the error out.
TEST(KeyframeGraph, SharesALoopsErrorOut) {
  KeyframeGraph graph;
  PlanarMotion X;
  const PlanarMotion step{{4.1, 0.0}, 0.5 * std::numbers::pi};
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.01, 0.01, 1e-6).asDiagonal();
  for (int i = 0; i < 5; ++i) {
    graph.add({X, {}, 1, Eigen::Matrix3d::Zero()});
    if (i > 0) graph.link({i - 1, i, i == 3 ? PlanarMotion{{3.8, 0.0}, step.yaw} : step, covariance});
    X = X * (i == 2 ? PlanarMotion{{3.8, 0.0}, step.yaw} : step);
  }
  EXPECT_GT((graph.keyframes()[4].X_SK.translation).norm(), 0.2);
  EXPECT_NEAR(graph.paths_from(0)[4], 4.1 * 3 + 3.8, 1e-9);
  graph.link({0, 4, {}, 1e-6 * Eigen::Matrix3d::Identity(), true, covariance});
  EXPECT_NEAR(graph.paths_from(0)[4], 0.0, 1e-9);
  EXPECT_NEAR(graph.paths_from(0)[2], 4.1 + 3.8, 1e-9) << "back over the loop";
  graph.straighten();
  EXPECT_LT(graph.keyframes()[4].X_SK.translation.norm(), 0.002);
  // Of the 0.3 m that are missing each of the four links takes a quarter.
  EXPECT_NEAR((graph.keyframes()[1].X_SK.translation - graph.keyframes()[0].X_SK.translation).norm(), 4.025, 0.002);
  EXPECT_NEAR((graph.keyframes()[3].X_SK.translation - graph.keyframes()[2].X_SK.translation).norm(), 3.875, 0.002);
  EXPECT_LT(graph.keyframes()[4].covariance(0, 0), 1e-4) << "the loop makes the end certain";
  EXPECT_GT(graph.keyframes()[2].covariance(0, 0), 0.01);
}

}  // namespace
}  // namespace waretwin
