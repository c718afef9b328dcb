#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/associate/evidence_grid.h"
#include "mapper/associate/evidence_shape.h"
#include "tests/mapper/evidence_fixtures.h"

namespace waretwin {
namespace {

using test::a_drive_past;
using test::box;
using test::camera_pose;
using test::EvidenceMapping;
using test::from_the_front;
using test::TracedScene;

// A cabinet with a conveyor on it, off the grid of headings.
Cuboid cabinet() { return box(0, 0, 0, 0, 0.9, 0.7, 0.75); }
Cuboid conveyor(double x = 0.0, double y = -0.03) { return box(x, y, 0.75, to_radians(3.37), 0.60, 0.40, 0.15); }

void expect_box(const Cuboid& found, const Cuboid& truth, double metres, double degrees) {
  EXPECT_LT((found.centre - truth.centre).cwiseAbs().maxCoeff(), metres) << (found.centre - truth.centre).transpose();
  EXPECT_LT((found.size - truth.size).cwiseAbs().maxCoeff(), 2 * metres) << (found.size - truth.size).transpose();
  EXPECT_LT(std::abs(std::remainder(found.yaw - truth.yaw, std::numbers::pi)), to_radians(degrees)) << to_degrees(found.yaw);
}

TEST(EvidenceGrid, CountsWhereRaysEndAndWhatTheyPass) {
  EvidenceConfig config;
  config.cell_m = config.slice_m = 0.01;
  config.end_path_m = 0.01;
  EvidenceGrid grid(config);
  // Straight down onto the middle of a cell, from above and from below the grid.
  const Eigen::AlignedBox3d around(Eigen::Vector3d(-0.02, -0.02, 0.0), Eigen::Vector3d(0.02, 0.02, 0.04));
  grid.add({0.005, 0.005, 2.0}, {{{0.005f, 0.005f, 0.015f}, RayKind::object}}, around);
  grid.add({0.005, 0.005, -2.0}, {{{0.005f, 0.005f, 0.015f}, RayKind::other}}, {});
  const auto at = [&](double x, double y, double z) -> const EvidenceCell& {
    const Eigen::Vector3i i =
        (Eigen::Vector3d(x, y, z) - grid.origin()).cwiseQuotient(grid.cell_size()).array().floor().matrix().cast<int>();
    return grid.cell(i.x(), i.y(), i.z());
  };
  EXPECT_EQ(at(0.005, 0.005, 0.015).object, 1);
  EXPECT_EQ(at(0.005, 0.005, 0.015).other, 1);
  EXPECT_NEAR(at(0.005, 0.005, 0.015).z_sum, 0.005, 1e-6);
  for (const double above : {0.035, 0.055, 0.105}) EXPECT_EQ(at(0.005, 0.005, above).passed, 1) << above;
  for (const double below : {-0.015, -0.045}) EXPECT_EQ(at(0.005, 0.005, below).passed, 1) << below;
  int hits = 0;
  for (int z = 0; z < grid.size().z(); ++z) {
    for (int y = 0; y < grid.size().y(); ++y) {
      for (int x = 0; x < grid.size().x(); ++x) {
        hits += grid.cell(x, y, z).hits();
        EXPECT_LE(grid.cell(x, y, z).passed, 2);
      }
    }
  }
  EXPECT_EQ(hits, 2);
}

TEST(EvidenceGrid, KeepsItsCountsWhenItGrowsAndWhenItsCellsDo) {
  EvidenceConfig config;
  config.max_cells = 60000;
  EvidenceGrid grid(config);
  const RandomStream random(3, "test", "grid");
  std::vector<EvidenceRay> rays;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d p(0.2 * random.uniform(3 * i), 0.2 * random.uniform(3 * i + 1), 0.1 * random.uniform(3 * i + 2));
    rays.push_back({p.cast<float>(), i % 3 == 0 ? RayKind::other : RayKind::object});
  }
  const auto counts = [&] {
    int object = 0, other = 0;
    double height = 0.0;
    for (int z = 0; z < grid.size().z(); ++z) {
      for (int y = 0; y < grid.size().y(); ++y) {
        for (int x = 0; x < grid.size().x(); ++x) {
          const EvidenceCell& cell = grid.cell(x, y, z);
          object += cell.object;
          other += cell.other;
          height += cell.z_sum + cell.object * (grid.origin().z() + z * grid.cell_size().z());
        }
      }
    }
    return std::tuple(object, other, height);
  };
  grid.add({0, 0, 2}, rays, Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.2, 0.2, 0.1)));
  const auto [object, other, height] = counts();
  EXPECT_EQ(object, 200);
  EXPECT_EQ(other, 100);
  const double cell_before = grid.cell_size().x();
  grid.add({0, 0, 2}, {}, Eigen::AlignedBox3d(Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0.2, 1, 0.1)));
  EXPECT_GT(grid.cell_size().x(), cell_before);
  EXPECT_LE(grid.size().cast<double>().prod(), config.max_cells);
  const auto [object_after, other_after, height_after] = counts();
  EXPECT_EQ(object_after, object);
  EXPECT_EQ(other_after, other);
  EXPECT_NEAR(height_after, height, 1e-3);
}

TEST(Evidence, GivesTheCuboidOfABoxOnACabinet) {
  const TracedScene scene{{cabinet(), conveyor()}, {}, true};
  EvidenceMapping mapping;
  for (const Pose& X_WC : a_drive_past()) mapping.look(scene, X_WC, {1}, 0.002);
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, conveyor(), 0.004, 0.3);
  EXPECT_EQ(mapping.map[0].observations, 8);
}

TEST(Evidence, LeavesOutWhatStandsBehindInTheBox) {
  // A bin on the same cabinet, which no view sees outside the box alone.
  const TracedScene scene{{cabinet(), conveyor(0, -0.1), box(0.05, 0.26, 0.75, 0, 0.25, 0.12, 0.10)}, {}, true};
  EvidenceMapping mapping;
  for (const Pose& X_WC : a_drive_past()) mapping.look(scene, X_WC, {1}, 0.002);
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, conveyor(0, -0.1), 0.005, 0.4);
}

TEST(Evidence, SplitsNeighbours) {
  const Cuboid left = box(-0.33, 0, 0.75, 0.02, 0.6, 0.4, 0.15), right = box(0.33, 0, 0.75, 0.02, 0.6, 0.4, 0.15);
  const TracedScene scene{{box(0, 0, 0, 0, 1.6, 0.7, 0.75), left, right}, {}, true};
  EvidenceMapping mapping;
  for (const double x : {-0.3, 0.0, 0.3}) {
    for (const double degrees : {-40.0, -10.0, 20.0, 45.0}) mapping.look(scene, from_the_front(degrees, 1.15, x), {1, 2}, 0.002);
  }
  ASSERT_EQ(mapping.finish().size(), 2u);
  const bool swapped = mapping.map[0].cuboid.centre.x() > 0;
  expect_box(mapping.map[swapped ? 1 : 0].cuboid, left, 0.01, 0.5);
  expect_box(mapping.map[swapped ? 0 : 1].cuboid, right, 0.01, 0.5);
}

TEST(Evidence, FindsTheNearSidesOfWhatWasSeenFromOneSide) {
  const TracedScene scene{{cabinet(), conveyor()}, {}, true};
  EvidenceMapping mapping;
  for (const double distance : {0.9, 0.95, 1.0, 1.05}) mapping.look(scene, from_the_front(0, distance), {1}, 0.002);
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, conveyor(), 0.006, 0.5);
}

TEST(Evidence, JoinsViewsThatThePictureCutsOff) {
  // A long conveyor on the floor, of which no picture holds the whole.
  const Cuboid tall = box(0, 0.35, 0, to_radians(1.3), 2.4, 0.6, 0.7);
  const TracedScene scene{{tall}, {}, true};
  EvidenceMapping mapping;
  for (const double x : {-1.3, -0.9, -0.5, 0.0, 0.5, 0.9, 1.3}) mapping.look(scene, from_the_front(0, 1.0, x), {0}, 0.002);
  for (const double x : {-1.9, 1.9}) mapping.look(scene, from_the_front(x > 0 ? 60 : -60, 0.8, x * 0.4, 0.2), {0}, 0.002);
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, tall, 0.012, 0.4);
}

TEST(Evidence, BridgesABeltThatGivesNoDepth) {
  // Two rails with a belt between them.
  const Cuboid belt = box(0, -0.03, 0.75, 0, 0.60, 0.30, 0.15), near_rail = box(0, -0.2, 0.75, 0, 0.60, 0.04, 0.15),
               far_rail = box(0, 0.14, 0.75, 0, 0.60, 0.04, 0.15);
  const TracedScene scene{{cabinet(), near_rail, belt, far_rail}, {}, true};
  EvidenceMapping mapping;
  for (const Pose& X_WC : a_drive_past()) {
    test::TracedFrame traced = test::trace(scene, mapping.intrinsics(), X_WC, 0.002);
    const cv::Rect2f whole = *traced.boxes[1] | *traced.boxes[2] | *traced.boxes[3];
    traced.frame.depth.setTo(0.0f, traced.masks[2]);
    mapping.take(std::move(traced.frame), X_WC, {{"conveyor", whole, 1.0f}});
  }
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, box(0, -0.03, 0.75, 0, 0.60, 0.38, 0.15), 0.005, 0.4);
}

TEST(EvidenceGrid, KeepsTheSharesOfAFullCell) {
  // An hour before the same object: three rays in four end in it, 5 mm up in its slice.
  EvidenceConfig config;
  EvidenceGrid grid(config);
  const Eigen::Vector3f hit(0.0025f, 0.0025f, 0.005f);
  const std::vector<EvidenceRay> rays{{hit, RayKind::object}, {hit, RayKind::object}, {hit, RayKind::other}, {hit, RayKind::object}};
  const Eigen::AlignedBox3d around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.01));
  for (int i = 0; i < 50000; ++i) grid.add({0.0, 0.0, 1.0}, rays, i == 0 ? around : Eigen::AlignedBox3d());
  const Eigen::Vector3i at = (hit.cast<double>() - grid.origin()).cwiseQuotient(grid.cell_size()).array().floor().matrix().cast<int>();
  const EvidenceCell& cell = grid.cell(at.x(), at.y(), at.z());
  EXPECT_GT(cell.object, 20000);
  EXPECT_NEAR(static_cast<double>(cell.object) / cell.hits(), 0.75, 0.01);
  EXPECT_NEAR(cell.z_sum / cell.object, 0.005, 5e-5);
}

TEST(Evidence, TellsConveyorsInARowApart) {
  // End to end, none of them ever in one picture as a whole: each box holds a piece of the neighbour's length.
  TracedScene scene{
      {box(-1.61, 0.35, 0, 0, 1.6, 0.6, 0.7), box(0, 0.35, 0, 0, 1.6, 0.6, 0.7), box(1.61, 0.35, 0, 0, 1.6, 0.6, 0.7)}, {}, true};
  EvidenceMapping mapping;
  for (double x = -2.4; x <= 2.41; x += 0.3) mapping.look(scene, from_the_front(0, 0.9, x), {0, 1, 2}, 0.002);
  for (double x = 2.4; x >= -2.41; x -= 0.4) {
    mapping.look(scene, camera_pose(x, 1.7, 1.4, -std::numbers::pi / 2, to_radians(45)), {0, 1, 2}, 0.002);
  }
  ASSERT_EQ(mapping.finish().size(), 3u);
  for (const Cuboid& truth : scene.boxes) {
    const auto nearest = std::min_element(mapping.map.begin(), mapping.map.end(), [&](const MappedObject& a, const MappedObject& b) {
      return (a.cuboid.centre - truth.centre).norm() < (b.cuboid.centre - truth.centre).norm();
    });
    EXPECT_GT(iou_3d(nearest->cuboid, canonical(truth)), 0.75);
  }
}

// A roller bed on legs: two rails, rollers with gaps between them, four legs. Its parts hang together nowhere.
std::vector<Cuboid> roller_bed(double y) {
  std::vector<Cuboid> parts{box(0, y - 0.22, 0.6, 0, 1.2, 0.04, 0.1), box(0, y + 0.22, 0.6, 0, 1.2, 0.04, 0.1)};
  for (int i = 0; i < 7; ++i) parts.push_back(box(-0.54 + 0.18 * i, y, 0.64, 0, 0.05, 0.34, 0.05));
  for (const double x : {-0.5, 0.5}) {
    for (const double side : {-0.22, 0.22}) parts.push_back(box(x, y + side, 0, 0, 0.05, 0.04, 0.56));
  }
  return parts;
}

TEST(Evidence, TellsAnOpenFrameFromTheWallSeenThroughIt) {
  TracedScene scene{roller_bed(0.0), {}, true};
  const std::size_t parts = scene.boxes.size();
  scene.boxes.push_back(box(0, 0.5, 0, 0, 5.0, 0.1, 1.5));
  EvidenceMapping mapping;
  for (const double degrees : {-35.0, -20.0, -10.0, 0.0, 10.0, 20.0, 35.0}) {
    const Pose X_WC = from_the_front(degrees, 1.2);
    test::TracedFrame traced = test::trace(scene, mapping.intrinsics(), X_WC, 0.002);
    cv::Rect2f whole = *traced.boxes[0];
    for (std::size_t i = 1; i < parts; ++i) {
      if (traced.boxes[i]) whole |= *traced.boxes[i];
    }
    mapping.take(std::move(traced.frame), X_WC, {{"conveyor", whole, 1.0f}});
  }
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, box(0, 0, 0, 0, 1.2, 0.48, 0.7), 0.012, 0.5);
}

TEST(Evidence, MergesHalves) {
  const TracedScene scene{{cabinet(), conveyor()}, {}, true};
  EvidenceMapping mapping;
  const Pose X_WC = from_the_front(0);
  const auto half = [&](bool left) {
    test::TracedFrame traced = test::trace(scene, mapping.intrinsics(), X_WC, 0.002);
    cv::Rect2f part = *traced.boxes[1];
    part.width *= 0.45f;
    if (!left) part.x += part.width / 0.45f * 0.55f;
    return mapping.take(std::move(traced.frame), X_WC, {{"conveyor", part, 1.0f}});
  };
  EXPECT_EQ(half(true), std::vector<int>{1});
  EXPECT_EQ(half(false), std::vector<int>{2});
  for (const Pose& X : a_drive_past()) mapping.look(scene, X, {1}, 0.002);
  ASSERT_EQ(mapping.finish().size(), 1u);
  EXPECT_EQ(mapping.map[0].id, 1);
  EXPECT_EQ(mapping.take_merges(), (std::vector<std::pair<int, int>>{{2, 1}}));
  expect_box(mapping.map[0].cuboid, conveyor(), 0.005, 0.4);
}

TEST(Evidence, TakesOutWhatWasSeenTooSeldomAndWhatWasNeverThere) {
  const TracedScene scene{{cabinet(), conveyor()}, {}, true};
  EvidenceMapping mapping;
  const std::vector<Pose> poses = a_drive_past();
  // A bin that a detector takes for a conveyor now and then.
  const TracedScene with_bin{{cabinet(), conveyor(0.0, -0.1), box(-1.2, 0.0, 0.0, 0.3, 0.3, 0.3, 0.3)}, {}, true};
  const auto beside = [&](int i) { return from_the_front(-30.0 + 5.0 * i, 1.2, -1.1); };
  for (int i = 0; i < 4; ++i) mapping.look(with_bin, beside(i), {2}, 0.002);
  for (int i = 0; i < 12; ++i) mapping.look(with_bin, beside(i), {}, 0.002);
  ASSERT_EQ(mapping.map.size(), 1u);
  // Seen twice only.
  mapping.look(with_bin, poses[3], {1}, 0.002);
  mapping.look(with_bin, poses[4], {1}, 0.002);
  ASSERT_EQ(mapping.map.size(), 2u);
  EXPECT_TRUE(mapping.finish().empty());
  EXPECT_EQ(mapping.take_merges(), (std::vector<std::pair<int, int>>{{1, 0}, {2, 0}})) << "labels go to the background";
}

TEST(Evidence, FollowsAnObjectThatWasPutElsewhere) {
  // Half the drive it stands on the left, then on the right: the place it left is seen to be empty.
  const Cuboid left = conveyor(-0.12), right = conveyor(0.12);
  EvidenceMapping mapping;
  for (const Pose& X_WC : a_drive_past()) mapping.look({{cabinet(), left}, {}, true}, X_WC, {1}, 0.002);
  for (int turn = 0; turn < 3; ++turn) {
    for (const Pose& X_WC : a_drive_past()) mapping.look({{cabinet(), right}, {}, true}, X_WC, {1}, 0.002);
  }
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, right, 0.02, 1.0);
}

TEST(Evidence, SecondBoxOnAnObjectIsNoOtherObject) {
  const TracedScene scene{{cabinet(), conveyor()}, {}, true};
  EvidenceMapping mapping;
  for (const Pose& X_WC : a_drive_past()) mapping.look(scene, X_WC, {1, 1}, 0.002);
  EXPECT_EQ(mapping.finish().size(), 1u);
}

TEST(Evidence, CutsATableOutBeforeTheChairUnderIt) {
  // Section 4.2 of the paper. The chair stands half under the table; its box lies in the table's.
  const Cuboid top = box(0, 0, 0.72, 0, 1.2, 0.8, 0.03);
  const Cuboid chair = box(0.1, -0.35, 0, 0.2, 0.40, 0.40, 0.45);
  TracedScene scene{{top, chair}, {}, true};
  for (const double x : {-0.57, 0.57}) {
    for (const double y : {-0.37, 0.37}) scene.boxes.push_back(box(x, y, 0, 0, 0.05, 0.05, 0.72));
  }
  EvidenceMapping mapping;
  for (const Pose& X_WC : a_drive_past()) {
    const Pose back = Eigen::Translation3d(0, -0.45, 0) * X_WC;
    test::TracedFrame traced = test::trace(scene, mapping.intrinsics(), back, 0.002);
    cv::Rect2f table = *traced.boxes[0];
    for (std::size_t leg = 2; leg < 6; ++leg) {
      if (traced.boxes[leg]) table |= *traced.boxes[leg];
    }
    mapping.take(std::move(traced.frame), back, {{"chair", *traced.boxes[1], 1.0f}, {"table", table, 1.0f}});
  }
  ASSERT_EQ(mapping.finish().size(), 2u);
  const MappedObject& first = mapping.map[0];
  const MappedObject& mapped_chair = first.class_name == "chair" ? first : mapping.map[1];
  const MappedObject& mapped_table = first.class_name == "chair" ? mapping.map[1] : first;
  EXPECT_EQ(mapped_table.class_name, "table");
  EXPECT_NEAR(mapped_table.cuboid.top(), 0.75, 0.005);
  EXPECT_NEAR(mapped_table.cuboid.size.x(), 1.2, 0.03);
  EXPECT_NEAR(mapped_table.cuboid.size.y(), 0.8, 0.03);
  // Of the chair what sticks out is seen: nothing of the table above it.
  EXPECT_LT(mapped_chair.cuboid.top(), 0.5);
  EXPECT_GT(iou_3d(mapped_chair.cuboid, chair), 0.4);
}

TEST(Evidence, ASingleFrameWithoutItsSupportDoesNotBringTheCabinetIn) {
  const TracedScene scene{{cabinet(), conveyor()}, {}, true};
  EvidenceMapping mapping;
  // From this near the ring around the box sees hardly anything of the cabinet: the floor is taken for the support.
  test::TracedFrame traced = test::trace(scene, mapping.intrinsics(), from_the_front(0), 0.002);
  const cv::Rect2f seen = *traced.boxes[1];
  const cv::Rect2f with_cabinet(seen.x - 60, seen.y - 10, seen.width + 120, seen.height + 120);
  mapping.take(std::move(traced.frame), from_the_front(0), {{"conveyor", with_cabinet, 1.0f}});
  for (const Pose& X_WC : a_drive_past()) mapping.look(scene, X_WC, {1}, 0.002);
  ASSERT_EQ(mapping.finish().size(), 1u);
  expect_box(mapping.map[0].cuboid, conveyor(), 0.006, 0.5);
}

}  // namespace
}  // namespace waretwin
