#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "core/parallel.h"
#include "mapper/segment/convex_segments.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin {
namespace {

using test::box;

// The thinned picture of the paper's camera, not thinned again.
const Intrinsics kView = test::kinect(640, 360);
const Pose kCamera = test::camera_pose(0, 0, 1.4, 0, to_radians(45));

GeometricConfig unthinned() {
  GeometricConfig config;
  config.thin = 1;
  return config;
}

ConvexSegments segments_of(const test::TracedFrame& traced, const GeometricConfig& config = unthinned()) {
  return find_convex_segments(traced.frame.depth, kView, 0.25, 3.86, config);
}

// Pixels of each segment where `mask` is set.
std::map<std::int32_t, int> counts_in(const ConvexSegments& segments, const cv::Mat& mask) {
  std::map<std::int32_t, int> counts;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (mask.at<std::uint8_t>(v, u)) ++counts[segments.labels[static_cast<std::size_t>(v * mask.cols + u)]];
    }
  }
  return counts;
}

// The segment that holds most of the mask, and its share of the mask.
std::pair<std::int32_t, double> main_segment(const ConvexSegments& segments, const cv::Mat& mask) {
  const auto counts = counts_in(segments, mask);
  const auto most = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {most->first, static_cast<double>(most->second) / cv::countNonZero(mask)};
}

TEST(ConvexSegments, NormalsAreThoseOfThePlaneAtAnyIncidence) {
  for (const double pitch_deg : {25.0, 45.0, 89.0}) {
    const Pose X_WC = test::camera_pose(0, 0, 1.4, 0.3, to_radians(pitch_deg));
    cv::Mat depth(kView.height, kView.width, CV_32FC1, cv::Scalar(0));
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const double slope = (X_WC.linear() * kView.ray(u, v)).z();
        if (slope < -0.1) depth.at<float>(v, u) = static_cast<float>(-1.4 / slope);
      }
    }
    const std::vector<SurfacePoint> surface = fit_surface(depth, kView, 9, 0.2);
    const Eigen::Vector3f up_C = (X_WC.linear().transpose() * Eigen::Vector3d::UnitZ()).cast<float>();
    int fitted = 0;
    for (const SurfacePoint& point : surface) {
      if (point.normal.isZero(0.0f)) continue;
      ++fitted;
      ASSERT_GT(point.normal.dot(up_C), 0.99999f) << pitch_deg;
      ASSERT_NEAR(point.p.dot(up_C), -1.4f, 1e-4f) << pitch_deg;
    }
    EXPECT_GT(fitted, cv::countNonZero(depth) * 0.99);
  }
}

TEST(ConvexSegments, TwoBoxesOnAFloorAreThreeSegments) {
  const test::TracedScene scene{{box(1.1, 0.45, 0, 0.4, 0.4, 0.3, 0.3), box(1.1, -0.45, 0, 1.0, 0.3, 0.3, 0.4)}, {}};
  for (const double sigma : {0.0, 0.002, 0.004}) {
    const test::TracedFrame traced = test::trace(scene, kView, kCamera, sigma, 3);
    const ConvexSegments segments = segments_of(traced);
    EXPECT_EQ(segments.count, 3) << sigma;
    const auto [left, left_share] = main_segment(segments, traced.masks[0]);
    const auto [right, right_share] = main_segment(segments, traced.masks[1]);
    // The convex edges between the faces of a box do not cut it; the concave ones to the floor and the steps behind do.
    EXPECT_GT(left_share, 0.93) << sigma;
    EXPECT_GT(right_share, 0.93) << sigma;
    cv::Mat floor = traced.frame.depth > 0.0f;
    for (const cv::Mat& mask : traced.masks) floor.setTo(0, mask);
    const auto [ground, ground_share] = main_segment(segments, floor);
    EXPECT_GT(ground_share, 0.9) << sigma;
    EXPECT_EQ((std::set<std::int32_t>{0, left, right, ground}.size()), 4u) << sigma;
  }
}

// A wall and a floor, once seen from inside the corner and once, as a block's top and front, from outside.
TEST(ConvexSegments, AConcaveCornerSplitsAndAConvexEdgeDoesNot) {
  const Pose low = test::camera_pose(0, 0, 0.8, 0, to_radians(35));
  const test::TracedFrame corner = test::trace({{box(2.2, 0, 0, 0, 2.0, 6.0, 2.0)}, {}}, kView, low);
  EXPECT_EQ(segments_of(corner).count, 2);
  const test::TracedFrame block = test::trace({{box(1.6, 0, -2.0, 0, 2.0, 6.0, 2.3)}, {}, false}, kView, low);
  const ConvexSegments one = segments_of(block);
  EXPECT_EQ(one.count, 1);
  EXPECT_GT(main_segment(one, block.masks[0]).second, 0.98);
}

TEST(ConvexSegments, AStepInDepthSplitsParallelPlanes) {
  // Seen from straight above, two tops are planes of one normal: no edge is concave, but for the step.
  const Pose above = test::camera_pose(0, 0, 1.4, 0, to_radians(90));
  for (const auto& [height, expected] : {std::pair{0.15, 2}, {0.005, 1}}) {
    const test::TracedFrame traced =
        test::trace({{box(0, 0, -1, 0, 9, 9, 1.0 + 0.3), box(0, 0, 0, 0, 0.5, 0.4, 0.3 + height)}, {}, false}, kView, above);
    EXPECT_EQ(segments_of(traced).count, expected) << height;
  }
}

TEST(ConvexSegments, SmallOnesAreDroppedAndEdgesGivenBack) {
  const test::TracedScene scene{{box(1.1, 0, 0, 0.2, 0.4, 0.3, 0.3), box(1.1, 0.6, 0, 0, 0.04, 0.04, 0.2)}, {}};
  const test::TracedFrame traced = test::trace(scene, kView, kCamera);
  GeometricConfig config = unthinned();
  config.min_segment_px = 2000;
  const ConvexSegments segments = segments_of(traced, config);
  EXPECT_EQ(segments.count, 2);
  config.grow_px = 0;
  const ConvexSegments bare = segments_of(traced, config);
  ASSERT_EQ(bare.count, 2);
  const auto labelled = [](const ConvexSegments& s) { return s.labels.size() - std::count(s.labels.begin(), s.labels.end(), 0); };
  EXPECT_GT(labelled(segments), labelled(bare));
  for (std::size_t i = 0; i < bare.labels.size(); ++i) {
    ASSERT_TRUE(bare.labels[i] == 0 || bare.labels[i] == segments.labels[i]);
  }
}

TEST(ConvexSegments, NothingMeasuredIsNoSegment) {
  const ConvexSegments none = find_convex_segments(cv::Mat::zeros(360, 640, CV_32FC1), kView, 0.25, 3.86, GeometricConfig{});
  EXPECT_EQ(none.count, 0);
  EXPECT_EQ(none.width, 320);
  EXPECT_EQ(none.labels, std::vector<std::int32_t>(320 * 180, 0));
}

TEST(ConvexSegments, AreTheSameAtAnyThreadCount) {
  const test::TracedFrame traced = test::trace({{box(1.1, 0, 0, 0.2, 0.4, 0.3, 0.3)}, {}}, kView, kCamera, 0.004, 5);
  const int before = thread_count();
  set_thread_count(1);
  const std::vector<std::int32_t> one = segments_of(traced).labels;
  set_thread_count(4);
  EXPECT_EQ(segments_of(traced).labels, one);
  set_thread_count(before);
}

}  // namespace
}  // namespace waretwin
