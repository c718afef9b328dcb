#include "mapper/own_body_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "sensors/mount.h"

namespace waretwin {
namespace {

StreamInfo vehicle() {
  StreamInfo info;
  StreamInfo::Camera& camera = info.cameras["camera"];
  camera.intrinsics = Intrinsics::from_field_of_view(80, 60, to_radians(90), to_radians(70));
  camera.X_BC = Mount{.z_m = 1.4, .pitch_deg = 50}.X_BC();
  info.lasers["laser"].X_BL = make_upright_pose(0.3, 0.2, 0.3, 0.5);
  info.own_body_B.emplace(Eigen::Vector3d(-0.45, -0.3, 0.0), Eigen::Vector3d(0.45, 0.3, 0.35));
  return info;
}

RgbdFrame frame_of(const StreamInfo& info, float depth) {
  RgbdFrame frame;
  frame.sensor = "camera";
  const Intrinsics& size = info.cameras.at("camera").intrinsics;
  frame.depth = cv::Mat(size.height, size.width, CV_32FC1, cv::Scalar::all(static_cast<double>(depth)));
  return frame;
}

TEST(OwnBodyMask, PixelsInTheBoxAndNoOthers) {
  const StreamInfo info = vehicle();
  const OwnBodyMask mask(info);
  int inside = 0;
  for (const float depth : {0.9f, 1.1f, 1.3f, 2.0f}) {
    RgbdFrame frame = frame_of(info, depth);
    const cv::Mat before = frame.depth;
    mask.mask(frame);
    EXPECT_EQ(cv::countNonZero(before), before.rows * before.cols);  // the source's own picture is left alone
    const StreamInfo::Camera& camera = info.cameras.at("camera");
    for (int v = 0; v < frame.depth.rows; ++v) {
      for (int u = 0; u < frame.depth.cols; ++u) {
        const Eigen::Vector3d p_B = camera.X_BC * (static_cast<double>(depth) * camera.intrinsics.ray(u, v));
        const Eigen::Vector3d low = p_B - info.own_body_B->min(), high = info.own_body_B->max() - p_B;
        if (std::min(low.cwiseAbs().minCoeff(), high.cwiseAbs().minCoeff()) < 1e-4) continue;  // on the box's skin
        EXPECT_EQ(frame.depth.at<float>(v, u) == 0.0f, info.own_body_B->contains(p_B)) << u << ", " << v << " at " << depth;
        inside += info.own_body_B->contains(p_B) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(OwnBodyMask, BeamsThatMeetTheVehicleReadNothing) {
  const OwnBodyMask mask(vehicle());
  LaserScan scan;
  scan.sensor = "laser";
  scan.angle_min = -2.0;
  scan.angle_increment = 0.5;
  scan.ranges = {0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 5.0f};
  const LaserScan before = scan;
  mask.mask(scan);
  int masked = 0;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = before.angle_min + static_cast<double>(i) * before.angle_increment, range = static_cast<double>(before.ranges[i]);
    const Eigen::Vector3d p_B = vehicle().lasers.at("laser").X_BL * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0);
    EXPECT_EQ(scan.ranges[i] == 0.0f, vehicle().own_body_B->contains(p_B)) << i;
    masked += scan.ranges[i] == 0.0f ? 1 : 0;
  }
  EXPECT_GT(masked, 0);
  EXPECT_LT(masked, 7);
}

TEST(OwnBodyMask, WithoutABodyNothingChanges) {
  StreamInfo info = vehicle();
  info.own_body_B.reset();
  RgbdFrame frame = frame_of(info, 1.2f);
  const cv::Mat before = frame.depth;
  OwnBodyMask(info).mask(frame);
  EXPECT_EQ(frame.depth.data, before.data);
  RgbdFrame strange = frame_of(info, 1.2f);
  strange.sensor = "another";
  EXPECT_THROW(OwnBodyMask(vehicle()).mask(strange), Error);
}

}  // namespace
}  // namespace waretwin
