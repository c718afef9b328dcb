#include "sensors/depth_registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>

#include "core/parallel.h"
#include "sensors/camera_config.h"
#include "sensors/time_of_flight.h"

namespace waretwin {
namespace {

struct Rig {
  CameraConfig camera;
  TimeOfFlightModel model{camera, 1, "camera"};
  Pose X_CD = camera.X_CD();
  Intrinsics view = camera.intrinsics();

  // Native depth of whatever `distance` says along a ray from the depth lens, both in the colour camera's frame.
  template <class Distance>
  cv::Mat native(Distance distance) const {
    cv::Mat depth(model.rays().size(), CV_32FC1, cv::Scalar(0));
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const cv::Vec3f& ray = model.rays().at<cv::Vec3f>(v, u);
        if (ray[2] == 0.0f) continue;
        depth.at<float>(v, u) = static_cast<float>(distance(X_CD.translation(), X_CD.linear() * Eigen::Vector3d(ray[0], ray[1], 1.0)));
      }
    }
    return depth;
  }
  cv::Mat registered(const cv::Mat& depth) const { return DepthRegistration(model.rays(), X_CD, Lens(view))(depth); }
};

double to_plane(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, const Eigen::Vector3d& n, double d) {
  const double t = (d - n.dot(origin)) / n.dot(ray);
  return t > 0.0 ? t : 0.0;
}

TEST(DepthRegistration, APlaneStaysThatPlaneToHalfAMillimetre) {
  const Rig rig;
  const Eigen::Vector3d n = Eigen::Vector3d(0.2, -0.3, 1.0).normalized();
  const cv::Mat depth = rig.registered(rig.native([&](const auto& o, const auto& r) { return to_plane(o, r, n, 1.5); }));
  int valid = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = depth.at<float>(v, u);
      if (z == 0.0f) continue;
      ASSERT_NEAR(z, to_plane({0, 0, 0}, rig.view.ray(u, v), n, 1.5), 0.0006) << u << " " << v;
      ++valid;
    }
  }
  // Without holes: the hexagon covers about half of the colour view.
  EXPECT_GT(valid, 380000);
  cv::Mat mask = depth > 0, closed;
  cv::Mat inner = mask(cv::Rect(400, 250, 480, 300));
  EXPECT_EQ(cv::countNonZero(inner), inner.rows * inner.cols);
}

// A post 0.3 m wide at 1 m before a wall at 2 m. The depth lens stands 32 mm to the left of the colour lens: beyond the post's right edge
// there is wall that the colour camera sees and the depth camera does not.
TEST(DepthRegistration, LeavesTheParallaxShadowEmpty) {
  const Rig rig;
  const cv::Mat depth = rig.registered(rig.native([](const Eigen::Vector3d& o, const Eigen::Vector3d& r) {
    const double post = to_plane(o, r, {0, 0, 1}, 1.0);
    const double x = o.x() + post * r.x();
    return std::abs(x) <= 0.15 ? post : to_plane(o, r, {0, 0, 1}, 2.0);
  }));
  const int v = 420;
  const auto column = [&](double x) { return static_cast<int>(std::lround(rig.view.fx * x + rig.view.cx)); };
  EXPECT_NEAR(depth.at<float>(v, column(0.0)), 1.0, 0.001);
  EXPECT_NEAR(depth.at<float>(v, column(-0.17)), 2.0, 0.001);
  // Seen by the colour camera just right of the post is x / z = 0.15; from the depth lens the post hides the wall up to
  // (0.15 + 0.032) * 2 - 0.032 = 0.332 m, which the colour camera sees at x / z = 0.166.
  for (const double x : {0.153, 0.157, 0.162}) EXPECT_EQ(depth.at<float>(v, column(x)), 0.0f) << x;
  EXPECT_NEAR(depth.at<float>(v, column(0.172)), 2.0, 0.001);
}

TEST(DepthRegistration, DrawsTheNearerSurfaceInFront) {
  const Rig rig;
  // To the left the depth camera looks behind the post's edge; the colour camera sees the post there.
  const cv::Mat depth = rig.registered(rig.native([](const Eigen::Vector3d& o, const Eigen::Vector3d& r) {
    const double post = to_plane(o, r, {0, 0, 1}, 0.6);
    return o.x() + post * r.x() >= -0.1 ? post : to_plane(o, r, {0, 0, 1}, 3.0);
  }));
  for (int u = 0; u < depth.cols; ++u) {
    const double x = rig.view.ray(u, 0).x() * 0.6;
    const float z = depth.at<float>(420, u);
    if (x > -0.098 && z != 0.0f) {
      EXPECT_NEAR(z, 0.6, 0.001) << u;
    }
  }
}

TEST(DepthRegistration, IsTheSameAtAnyThreadCount) {
  const Rig rig;
  const cv::Mat native = rig.native([](const Eigen::Vector3d& o, const Eigen::Vector3d& r) {
    return to_plane(o, r, {0, 0, 1}, r.x() > 0.1 ? 1.0 : 2.0 + 0.3 * r.y());
  });
  set_thread_count(1);
  const cv::Mat one = rig.registered(native);
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    const cv::Mat other = rig.registered(native);
    EXPECT_EQ(std::memcmp(one.data, other.data, one.total() * one.elemSize()), 0) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace waretwin
