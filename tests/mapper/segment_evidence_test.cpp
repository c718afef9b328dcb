#include <gtest/gtest.h>

#include <algorithm>

#include "tests/mapper/evidence_fixtures.h"

namespace waretwin {
namespace {

using test::box;
using test::TracedScene;

const TracedScene kScene{{box(0, 0, 0, 0, 0.9, 0.7, 0.75), box(0, 0, 0.75, 0.05, 0.6, 0.4, 0.15)}, {}, true};

int count(const std::vector<EvidenceRay>& rays, RayKind kind) {
  return static_cast<int>(std::count_if(rays.begin(), rays.end(), [kind](const EvidenceRay& ray) { return ray.kind == kind; }));
}

TEST(EvidenceSegmenter, TellsObjectFromOtherAndNamesTheSupport) {
  const Intrinsics intrinsics = test::kinect(640, 360);
  const Pose X_WC = test::from_the_front(20);
  const test::TracedFrame traced = test::trace(kScene, intrinsics, X_WC, 0.002);
  EvidenceSegmenter segmenter(SegmentConfig{}, EvidenceRaysConfig{}, test::kinect_stream(intrinsics));
  const Segmentation found = segmenter.segment(traced.frame, intrinsics, {{"conveyor", *traced.boxes[1], 1.0f}}, X_WC);
  ASSERT_EQ(found.objects.size(), 1u);
  const SegmentedObject& object = found.objects[0];
  ASSERT_TRUE(object.support_W);
  EXPECT_NEAR(*object.support_W, 0.75, 0.003);
  EXPECT_NEAR(object.ground_W, 0.0, 0.001);
  EXPECT_GT(count(object.rays, RayKind::object), 3000);
  EXPECT_GT(count(object.rays, RayKind::other), 3000);
  const Cuboid grown = {kScene.boxes[1].centre, kScene.boxes[1].yaw, kScene.boxes[1].size + Eigen::Vector3d::Constant(0.03), "world"};
  for (const EvidenceRay& ray : object.rays) {
    if (ray.kind != RayKind::object) continue;
    // Inside the box and above the cabinet there is nothing but the conveyor here.
    const Eigen::Vector3d p_O = grown.pose().inverse() * ray.hit_W.cast<double>();
    EXPECT_LE((p_O.cwiseAbs() - 0.5 * grown.size).maxCoeff(), 0.0);
  }
  ASSERT_EQ(object.pixels.size(), object.points_W.size());
  for (const int pixel : object.pixels) EXPECT_TRUE(traced.masks[1].data[pixel]);
}

TEST(EvidenceSegmenter, StandsOnTheTableNotOnItsShelf) {
  // The shelf reaches out and fills more of what lies around the box than the rim of the top does.
  const TracedScene scene{
      {box(0, -0.1, 0.15, 0, 1.4, 1.2, 0.05), box(0, 0, 0.72, 0, 0.85, 0.65, 0.03), box(0, 0, 0.75, 0.05, 0.6, 0.4, 0.15)}, {}, true};
  const Intrinsics intrinsics = test::kinect(640, 360);
  for (const double degrees : {-30.0, 0.0, 30.0}) {
    const Pose X_WC = test::from_the_front(degrees, 1.2);
    const test::TracedFrame traced = test::trace(scene, intrinsics, X_WC, 0.002);
    EvidenceSegmenter segmenter(SegmentConfig{}, EvidenceRaysConfig{}, test::kinect_stream(intrinsics));
    const Segmentation found = segmenter.segment(traced.frame, intrinsics, {{"conveyor", *traced.boxes[2], 1.0f}}, X_WC);
    ASSERT_EQ(found.objects.size(), 1u);
    ASSERT_TRUE(found.objects[0].support_W) << degrees;
    EXPECT_NEAR(*found.objects[0].support_W, 0.75, 0.005) << degrees;
  }
}

TEST(EvidenceSegmenter, LeavesOutFramesInFastRotation) {
  const Intrinsics intrinsics = test::kinect(640, 360);
  EvidenceSegmenter segmenter(SegmentConfig{}, EvidenceRaysConfig{.max_turn_deg_s = 20.0}, test::kinect_stream(intrinsics));
  const auto at = [&](double degrees, Stamp stamp) {
    const Pose X_WC = test::from_the_front(degrees);
    test::TracedFrame traced = test::trace(kScene, intrinsics, X_WC);
    traced.frame.stamp = stamp;
    return segmenter.segment(traced.frame, intrinsics, {{"conveyor", *traced.boxes[1], 1.0f}}, X_WC);
  };
  EXPECT_EQ(at(0, 0).objects.size(), 1u);
  const Segmentation fast = at(5, 200'000'000);  // 25 deg/s
  EXPECT_TRUE(fast.objects.empty());
  EXPECT_EQ(fast.rejected.at("camera turns too fast"), 1);
  EXPECT_EQ(at(8, 400'000'000).objects.size(), 1u);  // 15 deg/s
}

TEST(EvidenceSegmenter, SaysWhyABoxCameToNothing) {
  const Intrinsics intrinsics = test::kinect(640, 360);
  const Pose X_WC = test::from_the_front(0);
  test::TracedFrame traced = test::trace(kScene, intrinsics, X_WC, 0.002);
  EvidenceSegmenter segmenter(SegmentConfig{}, EvidenceRaysConfig{}, test::kinect_stream(intrinsics));
  // The floor before the cabinet.
  const Segmentation floor = segmenter.segment(traced.frame, intrinsics, {{"conveyor", {250, 300, 100, 50}, 1.0f}}, X_WC);
  EXPECT_TRUE(floor.objects.empty());
  EXPECT_EQ(floor.rejected.at("only ground or support"), 1);
  traced.frame.depth.setTo(0.0f);
  const Segmentation blind = segmenter.segment(traced.frame, intrinsics, {{"conveyor", *traced.boxes[1], 1.0f}}, X_WC);
  EXPECT_EQ(blind.rejected.at("no depth"), 1);
}

TEST(EvidenceSegmenter, RaysInTwoBoxesAreUnknownToBoth) {
  const Intrinsics intrinsics = test::kinect(640, 360);
  const Pose X_WC = test::from_the_front(0);
  const test::TracedFrame traced = test::trace(kScene, intrinsics, X_WC, 0.002);
  EvidenceSegmenter segmenter(SegmentConfig{}, EvidenceRaysConfig{}, test::kinect_stream(intrinsics));
  const Segmentation found =
      segmenter.segment(traced.frame, intrinsics, {{"conveyor", *traced.boxes[1], 1.0f}, {"table", *traced.boxes[1], 1.0f}}, X_WC);
  ASSERT_EQ(found.objects.size(), 2u);
  for (const SegmentedObject& object : found.objects) EXPECT_EQ(count(object.rays, RayKind::object), 0);
  // Nearly the same box of the same class is the same object.
  const Segmentation twice =
      segmenter.segment(traced.frame, intrinsics, {{"conveyor", *traced.boxes[1], 1.0f}, {"conveyor", *traced.boxes[1], 0.8f}}, X_WC);
  ASSERT_EQ(twice.objects.size(), 1u);
  EXPECT_GT(count(twice.objects[0].rays, RayKind::object), 3000);
  EXPECT_EQ(twice.rejected.at("second box on an object"), 1);
}

TEST(DepthRays, TakesTheDepthCamerasOwnPicture) {
  const Intrinsics colour = test::kinect(640, 360), native = Intrinsics::from_field_of_view(320, 288, to_radians(75), to_radians(65));
  const Pose X_WC = test::from_the_front(10);
  Pose X_CD = Pose::Identity();
  X_CD.translation() = Eigen::Vector3d(-0.032, 0.0, 0.002);
  X_CD.linear() = Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  StreamInfo info = test::kinect_stream(colour);
  info.cameras["camera"].native = DepthCameraView{Lens(native), X_CD};
  RgbdFrame frame = test::trace(kScene, colour, X_WC).frame;
  frame.native_depth = test::trace(kScene, native, X_WC * X_CD).frame.depth;
  for (const int thin : {1, 3}) {
    DepthRays rays(info, thin);
    const DepthPoints points = rays.points(frame, X_WC, 0.25, 3.86);
    EXPECT_EQ(points.width, (320 + thin - 1) / thin);
    EXPECT_LT((points.from_W - (X_WC * X_CD).translation()).norm(), 1e-9);
    int valid = 0;
    for (std::size_t i = 0; i < points.depth.size(); ++i) {
      if (points.depth[i] == 0.0f) continue;
      ++valid;
      const Eigen::Vector3d p_W = points.points_W[i].cast<double>();
      double off = std::abs(p_W.z());
      for (const Cuboid& cuboid : kScene.boxes) {
        const Eigen::Vector3d beyond = (cuboid.pose().inverse() * p_W).cwiseAbs() - 0.5 * cuboid.size;
        off = std::min(off, beyond.maxCoeff() > 0 ? beyond.cwiseMax(0.0).norm() : -beyond.maxCoeff());
      }
      EXPECT_LT(off, 0.002) << p_W.transpose();
      const Eigen::Vector2d pixel = colour.project(X_WC.inverse() * p_W);
      EXPECT_NEAR(points.pixels[i].x(), pixel.x() + 0.5, 0.01);
      EXPECT_NEAR(points.pixels[i].y(), pixel.y() + 0.5, 0.01);
    }
    EXPECT_GT(valid, 60000 / (thin * thin));
  }
}

}  // namespace
}  // namespace waretwin
