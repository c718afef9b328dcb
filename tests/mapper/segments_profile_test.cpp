// Profile voxbloxpp as a whole: traced frames through the mapper, from depth pictures to objects.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <utility>

#include "core/digest.h"
#include "core/parallel.h"
#include "mapper/integrate/label_surface.h"
#include "mapper/localise/simple_localisers.h"
#include "mapper/mapper.h"
#include "mapper/output/map_archive.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin {
namespace {

using test::box;

const Intrinsics kView = test::kinect(320, 180);

// A crate on a pallet beside a second one on the floor.
test::TracedScene two_crates() {
  return {{box(0, 0, 0, 0.3, 0.9, 0.7, 0.3), box(0, 0, 0.3, 0.3, 0.5, 0.35, 0.3), box(0.9, 0.1, 0, 0.0, 0.4, 0.3, 0.4)}, {}};
}

class BoxesOfTheScene final : public Detector {
 public:
  std::vector<Detection> detect(const RgbdFrame&) override { return boxes; }
  std::vector<Detection> boxes;
};

struct Drive {
  ObjectMap map;
  std::uint64_t digest = 0;
  std::vector<std::vector<int>> logged;  // ids of the named segments, by frame
};

Drive drive(double sigma, std::vector<double> degrees, LoadedMap* from = nullptr) {
  StreamInfo info = test::kinect_stream(kView);
  info.has_recorded_poses = true;
  MapperConfig config = MapperConfig::make("voxbloxpp");
  config.rate_hz = 0.0;
  config.geometric.thin = 1;
  config.geometric.min_segment_px = 60;
  config.geometric.normal_window_px = 5;
  config.geometric.convexity_window_px = 3;
  Stages stages = make_stages(config, info);
  auto detector = std::make_unique<BoxesOfTheScene>();
  BoxesOfTheScene& boxes = *detector;
  stages.detector = std::move(detector);
  Mapper mapper(config, std::move(stages), info);
  if (from) mapper.resume(std::move(*from));
  Drive result;
  mapper.on_frame = [&](const Mapper::FrameResult& frame) {
    result.logged.emplace_back();
    for (std::size_t i = 0; i < frame.map_ids.size(); ++i) {
      if (frame.segmentation.objects[i].detection_index >= 0) result.logged.back().push_back(frame.map_ids[i]);
    }
  };
  Stamp stamp = 0;
  for (const double degree : degrees) {
    const double a = to_radians(degree);
    const Pose X_WC = test::camera_pose(0.3 + 1.5 * std::sin(a), -1.5 * std::cos(a), 1.4, std::numbers::pi / 2 + a, to_radians(40));
    test::TracedFrame traced = test::trace(two_crates(), kView, X_WC, sigma, static_cast<std::uint64_t>(stamp));
    boxes.boxes = {{"crate", traced.boxes[1].value(), 1.0f}, {"crate", traced.boxes[2].value(), 1.0f}};
    traced.frame.stamp = stamp += 1'000'000'000LL;
    traced.frame.recorded_X_WC = X_WC;
    mapper.consume(std::move(traced.frame));
  }
  result.map = mapper.finish();
  Digest digest;
  result.map.volume->add_to(digest);
  for (const MappedObject& object : result.map.objects) {
    digest.add(object.id);
    for (int k = 0; k < 3; ++k) digest.add(object.cuboid.centre[k]), digest.add(object.cuboid.size[k]);
    digest.add(object.cuboid.yaw);
  }
  result.digest = digest.value();
  return result;
}

const std::vector<double> kAround = {-50, -25, 0, 25, 50};

TEST(VoxbloxppProfile, MapsWhatTheBoxesNameAndNothingElse) {
  const Drive result = drive(0.001, kAround);
  ASSERT_EQ(result.map.objects.size(), 2u);
  const test::TracedScene scene = two_crates();
  for (const int truth : {1, 2}) {
    double best = 0.0;
    for (const MappedObject& object : result.map.objects)
      best = std::max(best, iou_3d(object.cuboid, scene.boxes[static_cast<std::size_t>(truth)]));
    EXPECT_GT(best, 0.6) << truth;
  }
  // The volume names the objects' ids and the background, no segments.
  std::set<std::int32_t> named = {0};
  for (const MappedObject& object : result.map.objects) named.insert(object.id);
  for (std::size_t b = 0; b < result.map.volume->size(); ++b) {
    const TsdfBlock& block = result.map.volume->block(b);
    if (!block.surface) continue;
    for (const std::int32_t label : block.surface->labels.labels()) EXPECT_TRUE(named.contains(label)) << label;
  }
  // What a frame reports are ids of objects, from the second frame on: before, the volume shows none.
  ASSERT_EQ(result.logged.size(), kAround.size());
  for (std::size_t i = 1; i < result.logged.size(); ++i) {
    EXPECT_FALSE(result.logged[i].empty());
    for (const int id : result.logged[i]) EXPECT_TRUE(named.contains(id)) << id;
  }
}

TEST(VoxbloxppProfile, AnObjectHasAllThePointsThatTheVolumeLabels) {
  const Drive result = drive(0.001, kAround);
  const Eigen::AlignedBox3d everywhere(Eigen::Vector3d::Constant(-1e3), Eigen::Vector3d::Constant(1e3));
  const auto before = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  for (const MappedObject& object : result.map.objects) {
    std::vector<Eigen::Vector3f> listed = object.points_W, all = label_surface(*result.map.volume, {{object.id, everywhere}}).at(object.id);
    std::sort(listed.begin(), listed.end(), before);
    std::sort(all.begin(), all.end(), before);
    // A voxel may have gone to the background since, whose segments are one at the end.
    EXPECT_TRUE(std::includes(listed.begin(), listed.end(), all.begin(), all.end(), before));
    EXPECT_GT(all.size(), 0.9 * static_cast<double>(listed.size()));
  }
}

TEST(VoxbloxppProfile, IsTheSameAtAnyThreadCount) {
  const int before = thread_count();
  set_thread_count(1);
  const std::uint64_t one = drive(0.003, {-25, 0, 25}).digest;
  set_thread_count(4);
  EXPECT_EQ(drive(0.003, {-25, 0, 25}).digest, one);
  set_thread_count(before);
}

TEST(VoxbloxppProfile, GoesOnFromItsOwnMap) {
  Drive first = drive(0.001, {-50, -25, 0});
  ASSERT_EQ(first.map.objects.size(), 2u);
  LoadedMap saved;
  saved.objects = first.map.objects;
  saved.volume = std::move(first.map.volume);
  saved.frames = 3;
  const Drive second = drive(0.001, {25, 50}, &saved);
  ASSERT_EQ(second.map.objects.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(second.map.objects[i].id, first.map.objects[i].id);
}

}  // namespace
}  // namespace waretwin
