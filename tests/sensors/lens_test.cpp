#include "sensors/lens.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "core/pose.h"
#include "sensors/camera_config.h"

namespace waretwin {
namespace {

TEST(Lens, AgreesWithOpenCvsRationalModel) {
  const Distortion d = {.k1 = 0.31, .k2 = -0.12, .k3 = 0.02, .k4 = 0.05, .k5 = 0.01, .k6 = -0.003, .p1 = 0.002, .p2 = -0.001};
  const Lens lens(Intrinsics::checked(640, 480, 500, 510, 321, 238), d);
  const cv::Matx33d k(500, 0, 321, 0, 510, 238, 0, 0, 1);
  const std::vector<double> coefficients = {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6};
  std::vector<cv::Point3d> points;
  for (double y = -0.5; y <= 0.5; y += 0.125) {
    for (double x = -0.5; x <= 0.5; x += 0.125) points.emplace_back(2.5 * x, 2.5 * y, 2.5);
  }
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), k, coefficients, pixels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = lens.project({points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x(), pixels[i].x, 1e-9);
    EXPECT_NEAR(pixel->y(), pixels[i].y, 1e-9);
  }
}

TEST(Lens, SlopesAreThoseOfTheDistortion) {
  const Distortion d = {.k1 = 0.31, .k2 = -0.12, .k3 = 0.02, .k4 = 0.05, .k5 = 0.01, .k6 = -0.003, .p1 = 0.02, .p2 = -0.01};
  constexpr double kStep = 1e-6;
  for (double x = -0.9; x <= 0.9; x += 0.3) {
    for (double y = -0.7; y <= 0.7; y += 0.2) {
      Eigen::Matrix2d quotients;
      quotients << (d.apply({x + kStep, y}) - d.apply({x - kStep, y})) / (2.0 * kStep),
          (d.apply({x, y + kStep}) - d.apply({x, y - kStep})) / (2.0 * kStep);
      EXPECT_LT((d.slope({x, y}) - quotients).norm(), 1e-8) << x << " " << y;
    }
  }
}

TEST(Lens, RaysOfPixelsComeBackToThem) {
  for (const char* mode : {"nfov_unbinned", "nfov_2x2binned", "wfov_2x2binned", "wfov_unbinned"}) {
    CameraConfig camera;
    camera.set_depth_mode(mode);
    const Lens lens = camera.depth_lens();
    int rays = 0;
    for (int v = 0; v < lens.intrinsics().height; v += 7) {
      for (int u = 0; u < lens.intrinsics().width; u += 7) {
        const auto ray = lens.ray(u, v);
        if (!ray) continue;
        const auto pixel = lens.project(3.0 * *ray);
        ASSERT_TRUE(pixel) << mode << " " << u << " " << v;
        ASSERT_NEAR(pixel->x(), u, 1e-6);
        ASSERT_NEAR(pixel->y(), v, 1e-6);
        ++rays;
      }
    }
    EXPECT_GT(rays, lens.intrinsics().width * lens.intrinsics().height / 49 * 3 / 4) << mode;
  }
}

// The whole field of interest of each mode falls onto the chip, and fills it to nine tenths.
TEST(Lens, FieldsOfTheDepthModesFillTheirImages) {
  for (const char* mode : {"nfov_unbinned", "nfov_2x2binned", "wfov_2x2binned", "wfov_unbinned"}) {
    CameraConfig camera;
    camera.set_depth_mode(mode);
    const Lens lens = camera.depth_lens();
    const auto right = lens.project({std::tan(to_radians(0.5 * camera.field.horizontal_deg)), 0, 1});
    const auto below = lens.project({0, std::tan(to_radians(0.5 * camera.field.vertical_deg)), 1});
    ASSERT_TRUE(right && below) << mode;
    EXPECT_LT(right->x(), lens.intrinsics().width - 0.5) << mode;
    EXPECT_LT(below->y(), lens.intrinsics().height - 0.5) << mode;
    EXPECT_GT(right->x(), 0.94 * lens.intrinsics().width) << mode;
    EXPECT_GT(below->y(), 0.94 * lens.intrinsics().height) << mode;
  }
}

TEST(Lens, WithoutDistortionTheFieldStillFits) {
  for (const char* mode : {"nfov_unbinned", "wfov_unbinned"}) {
    CameraConfig camera;
    camera.set_depth_mode(mode);
    camera.time_of_flight.lens_distortion = false;
    const Lens lens = camera.depth_lens();
    const auto corner = lens.project(
        {std::tan(to_radians(0.499 * camera.field.horizontal_deg)), std::tan(to_radians(0.499 * camera.field.vertical_deg)), 1});
    ASSERT_TRUE(corner);
    EXPECT_TRUE(lens.intrinsics().contains(corner->x(), corner->y())) << mode;
  }
}

TEST(Lens, SaysWhereTheDistortionFoldsOver) {
  // r (1 - r^2) grows up to r = 0.577, where it is 0.385.
  const Lens lens(Intrinsics::checked(100, 100, 100, 100, 50, 50), {.k1 = -1.0});
  EXPECT_TRUE(lens.project({0.55, 0, 1}));
  EXPECT_FALSE(lens.project({0.6, 0, 1}));
  EXPECT_FALSE(lens.project({0, 0, -1}));
  EXPECT_TRUE(lens.ray(50 + 38, 50));
  EXPECT_FALSE(lens.ray(50 + 39, 50));
}

}  // namespace
}  // namespace waretwin
