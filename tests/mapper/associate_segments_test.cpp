#include <gtest/gtest.h>

#include "mapper/associate/segment_associator.h"
#include "mapper/integrate/label_surface.h"

namespace waretwin {
namespace {

// A level square of side 0.4 m at z = 0.01 with its lower corner at (x, y), points 1 cm apart: 20 x 20 voxels of 2 cm.
std::vector<Eigen::Vector3f> square(double x, double y, int across = 40, int along = 40) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < across; ++i) {
    for (int k = 0; k < along; ++k) {
      points.emplace_back(static_cast<float>(x + 0.01 * i + 0.005), static_cast<float>(y + 0.01 * k + 0.005), 0.01f);
    }
  }
  return points;
}

// A volume that holds what the associator was shown, as an integrator would leave it: a level surface at z = 0.01.
class Bench {
 public:
  explicit Bench(const SegmentsConfig& config = {}) : associator(config) {}

  SegmentedObject segment(std::vector<Eigen::Vector3f> points, int detection = -1, const char* name = "") {
    SegmentedObject object;
    object.points_W = std::move(points);
    object.detection_index = detection;
    object.detection.class_name = name;
    return object;
  }

  std::vector<int> take(const std::vector<SegmentedObject>& objects) {
    AssociationContext context;
    context.frame_id = frame_++;
    context.volume = &volume;
    const std::vector<int> labels = associator.associate(objects, context, map);
    volume.merge_labels(associator.take_merges());
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (const Eigen::Vector3f& p_W : objects[i].points_W) put(p_W.cast<double>(), labels[i]);
    }
    return labels;
  }

  void finish() {
    associator.finish(map, volume);
    volume.merge_labels(associator.take_merges());
  }

  std::int32_t label_at(double x, double y) const { return volume.label(volume.voxel_at({x, y, 0.01})); }

  TsdfVolume volume{TsdfConfig{}};
  SegmentAssociator associator;
  ObjectList map;

 private:
  void put(const Eigen::Vector3d& p_W, int label) {
    for (const int dz : {0, -1}) {
      const Eigen::Vector3i voxel = volume.voxel_at(p_W) + Eigen::Vector3i(0, 0, dz);
      SurfaceVoxels& surface = volume.ensure_surface(volume.ensure_block(TsdfVolume::block_of(voxel)));
      TsdfVoxel& at = surface.voxels[static_cast<std::size_t>(TsdfVolume::offset_of(voxel))];
      at.distance = dz == 0 ? 0.005f : -0.015f;
      at.weight = 1.0f;
      surface.labels.add(TsdfVolume::offset_of(voxel), label);
    }
  }
  int frame_ = 0;
};

TEST(VoxelOverlap, CountsEachVoxelOnceByLabel) {
  Bench bench;
  const std::vector<int> labels = bench.take({bench.segment(square(0, 0)), bench.segment(square(0.4, 0))});
  // Half on the first, a quarter on the second, a quarter on nothing.
  const VoxelOverlap overlap = voxel_overlap(square(0.2, 0.0, 80, 40), bench.volume);
  EXPECT_EQ(overlap.voxels, 800);
  EXPECT_EQ(overlap.labels, (std::map<std::int32_t, int>{{labels[0], 200}, {labels[1], 400}}));
  EXPECT_TRUE(voxel_overlap({}, bench.volume).labels.empty());
}

TEST(MatchLabels, TakesTheLargestOverlapFirstAndEachLabelOnce) {
  std::vector<VoxelOverlap> overlaps(4);
  overlaps[0].labels = {{1, 50}};
  overlaps[1].labels = {{1, 80}, {2, 30}};
  overlaps[2].labels = {{1, 70}, {2, 25}};
  overlaps[3].labels = {{3, 19}};
  EXPECT_EQ(match_labels(overlaps, 20), (std::vector<std::int32_t>{0, 1, 2, 0}));
}

TEST(SegmentAssociator, FindsSegmentsAgainByTheirVoxels) {
  Bench bench;
  const auto first = bench.take({bench.segment(square(0, 0)), bench.segment(square(1, 0))});
  EXPECT_NE(first[0], first[1]);
  const auto second = bench.take({bench.segment(square(1.1, 0)), bench.segment(square(5, 0)), bench.segment(square(0.02, 0))});
  EXPECT_EQ(second[0], first[1]);
  EXPECT_EQ(second[2], first[0]);
  EXPECT_TRUE(second[1] != first[0] && second[1] != first[1]);
}

TEST(SegmentAssociator, SegmentsThatFramesSeeAsOneBecomeOne) {
  SegmentsConfig config;
  config.merging_min_frame_count = 3;
  Bench bench(config);
  std::vector<int> apart, joined;
  for (int frame = 0; frame < 4; ++frame) apart = bench.take({bench.segment(square(0, 0)), bench.segment(square(0.4, 0))});
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_NE(bench.label_at(0.1, 0.2), bench.label_at(0.7, 0.2)) << "only the third frame settles it";
    joined = bench.take({bench.segment(square(0, 0, 80, 40))});
  }
  EXPECT_EQ(joined[0], apart[0]) << "the older label stays";
  EXPECT_EQ(bench.label_at(0.1, 0.2), apart[0]);
  EXPECT_EQ(bench.label_at(0.7, 0.2), apart[0]);
  // Seen apart again, one of the two is a new segment.
  const auto again = bench.take({bench.segment(square(0, 0)), bench.segment(square(0.4, 0))});
  EXPECT_NE(again[0], again[1]);
}

TEST(SegmentAssociator, ASliverOfAnotherSegmentJoinsNothing) {
  SegmentsConfig config;
  config.merging_min_frame_count = 1;
  Bench bench(config);
  bench.take({bench.segment(square(0, 0)), bench.segment(square(0.4, 0))});
  // 0.4 m and a sixth of the second: 14 % of its own voxels lie there, where 20 % are asked for.
  bench.take({bench.segment(square(0, 0, 46, 40))});
  EXPECT_NE(bench.label_at(0.1, 0.2), bench.label_at(0.7, 0.2));
}

TEST(SegmentAssociator, TheSegmentsOfOneBoxAreOneObject) {
  Bench bench;
  const std::vector<SegmentedObject> frame = {bench.segment(square(0, 0), 0, "crate"), bench.segment(square(0.4, 0), 0, "crate"),
                                              bench.segment(square(0, 0.5))};
  std::vector<int> labels;
  for (int i = 0; i < 3; ++i) labels = bench.take(frame);
  EXPECT_NE(labels[0], labels[1]);
  ASSERT_EQ(bench.map.size(), 1u);
  EXPECT_EQ(bench.associator.object_of(labels[0]), bench.map[0].id);
  EXPECT_EQ(bench.associator.object_of(labels[1]), bench.map[0].id);
  EXPECT_EQ(bench.associator.object_of(labels[2]), 0);
  bench.finish();
  ASSERT_EQ(bench.map.size(), 1u);
  const MappedObject& object = bench.map[0];
  EXPECT_EQ(object.class_name, "crate");
  EXPECT_EQ(object.observations, 3);
  // Points stand at voxel centres: half a voxel is missing on each side.
  EXPECT_NEAR(object.cuboid.size.x(), 0.78, 1e-3);
  EXPECT_NEAR(object.cuboid.size.y(), 0.38, 1e-3);
  EXPECT_NEAR(object.cuboid.centre.x(), 0.4, 1e-3);
  EXPECT_NEAR(object.cuboid.centre.y(), 0.2, 1e-3);
  // The volume now names objects, and what is none is background.
  EXPECT_EQ(bench.label_at(0.1, 0.2), object.id);
  EXPECT_EQ(bench.label_at(0.7, 0.2), object.id);
  EXPECT_EQ(bench.label_at(0.1, 0.7), 0);
}

TEST(SegmentAssociator, TouchingObjectsStayTwo) {
  SegmentsConfig config;
  config.merging_min_frame_count = 1;
  Bench bench(config);
  for (int i = 0; i < 4; ++i) bench.take({bench.segment(square(0, 0), 0, "crate"), bench.segment(square(0.4, 0), 1, "crate")});
  bench.finish();
  ASSERT_EQ(bench.map.size(), 2u);
  EXPECT_NE(bench.map[0].id, bench.map[1].id);
  for (const MappedObject& object : bench.map) EXPECT_NEAR(object.cuboid.size.x(), 0.38, 1e-3);
}

TEST(SegmentAssociator, AnInstanceIsFoundAgainByOneOfItsSegments) {
  Bench bench;
  bench.take({bench.segment(square(0, 0), 0, "crate"), bench.segment(square(0.4, 0), 0, "crate")});
  // The frame sees one of them only, beside a part that was not seen before.
  bench.take(
      {bench.segment(square(0.8, 0), 1, "crate"), bench.segment(square(0.4, 0), 1, "crate"), bench.segment(square(3, 0), 0, "crate")});
  bench.finish();
  ASSERT_EQ(bench.map.size(), 2u);
  EXPECT_NEAR(bench.map[0].cuboid.size.x(), 1.18, 1e-3);
  EXPECT_NEAR(bench.map[1].cuboid.centre.x(), 3.2, 1e-3);
}

TEST(SegmentAssociator, ClassesAreVotedFor) {
  Bench bench;
  for (const char* name : {"table", "crate", "crate"}) bench.take({bench.segment(square(0, 0), 0, name)});
  bench.finish();
  ASSERT_EQ(bench.map.size(), 1u);
  EXPECT_EQ(bench.map[0].class_name, "crate");
}

TEST(SegmentAssociator, FramesWithoutTheObjectSpeakAgainstItIfAskedFor) {
  for (const auto& [factor, objects] : {std::pair{0.0, 1u}, {0.5, 0u}}) {
    SegmentsConfig config;
    config.background_factor = factor;
    Bench bench(config);
    bench.take({bench.segment(square(0, 0), 0, "crate")});
    for (int i = 0; i < 3; ++i) bench.take({bench.segment(square(0, 0))});
    bench.finish();
    EXPECT_EQ(bench.map.size(), objects) << factor;
    EXPECT_EQ(bench.label_at(0.1, 0.2) != 0, objects == 1u);
  }
}

TEST(SegmentAssociator, GoesOnFromAMap) {
  Bench before;
  for (int i = 0; i < 3; ++i) before.take({before.segment(square(0, 0), 0, "crate")});
  before.finish();
  const int id = before.map.at(0).id;
  SegmentAssociator later(SegmentsConfig{});
  ObjectList map = before.map;
  AssociationContext context;
  context.frame_id = 3;
  context.volume = &before.volume;
  const auto labels = later.associate({before.segment(square(0, 0), 0, "crate"), before.segment(square(2, 0), 1, "crate")}, context, map);
  EXPECT_EQ(labels[0], id);
  EXPECT_EQ(later.object_of(labels[0]), id);
  EXPECT_GT(labels[1], id);
  ASSERT_EQ(map.size(), 1u);
  EXPECT_EQ(map[0].observations, 4);
}

TEST(SegmentRecords, AThingIsTheInstanceItsSegmentsWereSeenWithMostOften) {
  SegmentRecords records(0.0);
  records.see(1, 10, "a", 5);
  records.see(2, 11, "a", 3);
  // Both things hold a segment of instance 10: it goes to the one with the larger count, the other takes its second choice.
  records.see(3, 10, "a", 2);
  EXPECT_EQ(records.match_instances({{1, 0}, {2, 1}, {3, 1}}, 3), (std::vector<int>{10, 11, 0}));
  EXPECT_EQ(records.match_instances({{3, 0}, {1, 1}}, 2), (std::vector<int>{0, 10}));
  records.merge(2, 1);
  EXPECT_EQ(records.instance_of(1), 10);
  EXPECT_EQ(records.instance_of(2), 0);
  EXPECT_EQ(records.instances(), (std::map<int, std::vector<int>>{{10, {1, 3}}}));
}

TEST(LabelSurface, PointsLieWhereTheDistancePassesZero) {
  Bench bench;
  const auto labels = bench.take({bench.segment(square(0, 0)), bench.segment(square(1, 0))});
  const Eigen::AlignedBox3d first(Eigen::Vector3d(0.0, 0.0, -0.02), Eigen::Vector3d(0.4, 0.4, 0.02));
  const auto points = label_surface(bench.volume, {{labels[0], first}, {labels[1], first}});
  ASSERT_EQ(points.size(), 1u);
  ASSERT_EQ(points.at(labels[0]).size(), 400u);
  // Distances of -15 and 5 mm at z = -0.01 and 0.01: zero at three quarters of the way.
  for (const Eigen::Vector3f& p_W : points.at(labels[0])) EXPECT_NEAR(p_W.z(), 0.005f, 1e-6f);
  EXPECT_TRUE(label_surface(bench.volume, {}).empty());
  EXPECT_TRUE(label_surface(bench.volume, {{labels[1], first}}).empty()) << "not where its box is";
}

}  // namespace
}  // namespace waretwin
