#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "mapper/segment/geometric_segmenter.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin {
namespace {

using test::box;

const Intrinsics kView = test::kinect(640, 360);
const Pose kCamera = test::camera_pose(0, 0, 1.4, 0, to_radians(45));

// Two boxes apart from each other.
const test::TracedScene kScene{{box(1.1, 0.45, 0, 0.4, 0.4, 0.3, 0.3), box(1.1, -0.45, 0, 1.0, 0.3, 0.3, 0.4)}, {}};

Segmentation segment(const RgbdFrame& frame, const std::vector<Detection>& detections, double box_share = 0.8) {
  GeometricConfig config;
  config.thin = 1;
  config.box_share = box_share;
  return GeometricSegmenter(SegmentConfig{}, config, test::kinect_stream(kView)).segment(frame, kView, detections, kCamera);
}

TEST(GeometricSegmenter, ABoxNamesTheSegmentInItAndNoOther) {
  const test::TracedFrame traced = test::trace(kScene, kView, kCamera);
  const Segmentation result = segment(traced.frame, {{"crate", *traced.boxes[1], 0.5f}});
  ASSERT_EQ(result.objects.size(), 3u) << "the floor and the other box are segments, too";
  EXPECT_TRUE(result.rejected.empty());
  int named = 0;
  for (const SegmentedObject& object : result.objects) {
    ASSERT_EQ(object.pixels.size(), object.points_W.size());
    EXPECT_TRUE(std::is_sorted(object.pixels.begin(), object.pixels.end()));
    if (object.detection_index < 0) {
      EXPECT_EQ(object.detection.class_name, "");
      continue;
    }
    ++named;
    EXPECT_EQ(object.detection.class_name, "crate");
    int hits = 0;
    for (const int pixel : object.pixels) hits += traced.masks[1].at<std::uint8_t>(pixel / 640, pixel % 640) != 0;
    EXPECT_GT(hits, 0.97 * static_cast<double>(object.pixels.size()));
    // Points are in the world: none above the box's lid or below the floor.
    for (const Eigen::Vector3f& p_W : object.points_W) {
      ASSERT_GT(p_W.z(), -0.01f);
      ASSERT_LT(p_W.z(), 0.41f);
    }
  }
  EXPECT_EQ(named, 1);
}

TEST(GeometricSegmenter, ASegmentThatReachesOutOfTheBoxIsBackground) {
  const test::TracedFrame traced = test::trace(kScene, kView, kCamera);
  cv::Rect2f half = *traced.boxes[0];
  half.width *= 0.6f;
  const Segmentation strict = segment(traced.frame, {{"crate", half, 0.5f}});
  EXPECT_EQ(strict.rejected.at("no segment in the box"), 1);
  for (const SegmentedObject& object : strict.objects) EXPECT_EQ(object.detection_index, -1);
  const Segmentation lax = segment(traced.frame, {{"crate", half, 0.5f}}, 0.3);
  EXPECT_TRUE(lax.rejected.empty());
}

TEST(GeometricSegmenter, AScrapInTheBoxIsBackground) {
  const test::TracedFrame traced = test::trace(kScene, kView, kCamera);
  const cv::Rect2f both = *traced.boxes[0] | *traced.boxes[1];
  // The first box of the scene fills about a fifth of the rectangle around both.
  for (const auto& [fill, named] : {std::pair{0.0, true}, {0.05, true}, {0.5, false}}) {
    GeometricConfig config;
    config.thin = 1;
    config.min_box_fill = fill;
    const Segmentation result = GeometricSegmenter(SegmentConfig{}, config, test::kinect_stream(kView))
                                    .segment(traced.frame, kView, {{"pair", both, 1.0f}}, kCamera);
    const bool any = std::any_of(result.objects.begin(), result.objects.end(), [](const auto& o) { return o.detection_index == 0; });
    EXPECT_EQ(any, named) << fill;
    EXPECT_EQ(result.rejected.empty(), named) << fill;
  }
}

TEST(GeometricSegmenter, OfSeveralBoxesTheSmallestHoldsTheSegment) {
  const test::TracedFrame traced = test::trace(kScene, kView, kCamera);
  const cv::Rect2f both = *traced.boxes[0] | *traced.boxes[1];
  const Segmentation result = segment(traced.frame, {{"pair", both, 1.0f}, {"crate", *traced.boxes[0], 0.5f}});
  std::set<std::string> names;
  for (const SegmentedObject& object : result.objects) {
    if (object.detection_index >= 0) names.insert(object.detection.class_name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"pair", "crate"}));
}

TEST(GeometricSegmenter, AMaskNamesItsSegmentsWhateverTheBoxesHold) {
  const test::TracedFrame traced = test::trace(kScene, kView, kCamera);
  const cv::Rect2f both = *traced.boxes[0] | *traced.boxes[1];
  const cv::Rect whole(0, 0, 640, 360);
  const MaskRuns mask{whole.size(), run_lengths(traced.masks[0], whole, whole.size())};
  // The mask's box is the larger one, and the other detection's box holds both segments.
  const Segmentation result = segment(traced.frame, {{"pair", both, 1.0f}, {"crate", cv::Rect2f(whole), 0.5f, mask}});
  for (const SegmentedObject& object : result.objects) {
    int hits = 0;
    for (const int pixel : object.pixels) hits += traced.masks[0].at<std::uint8_t>(pixel / 640, pixel % 640) != 0;
    EXPECT_EQ(object.detection.class_name == "crate", 2 * hits > static_cast<int>(object.pixels.size()));
  }
  EXPECT_TRUE(result.rejected.empty()) << "the box names the other one";
}

TEST(GeometricSegmenter, PixelsBetweenThinnedOnesGoToTheSegmentOfTheirDepth) {
  const test::TracedFrame traced = test::trace(kScene, kView, kCamera);
  GeometricConfig config;
  config.thin = 2;
  config.min_segment_px = 50;
  const Segmentation result = GeometricSegmenter(SegmentConfig{}, config, test::kinect_stream(kView))
                                  .segment(traced.frame, kView, {{"crate", *traced.boxes[0], 0.5f}}, kCamera);
  for (const SegmentedObject& object : result.objects) {
    if (object.detection_index < 0) continue;
    int hits = 0;
    for (const int pixel : object.pixels) hits += traced.masks[0].at<std::uint8_t>(pixel / 640, pixel % 640) != 0;
    EXPECT_GT(hits, 0.95 * static_cast<double>(object.pixels.size()));
    EXPECT_GT(hits, 0.9 * cv::countNonZero(traced.masks[0]));
  }
}

}  // namespace
}  // namespace waretwin
