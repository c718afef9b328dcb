#include "sensors/depth_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "core/parallel.h"
#include "sensors/depth_field.h"
#include "sensors/measurements.h"
#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

// No field mask, no dropout, wide range: what is left is the Gaussian error.
CameraConfig open_camera(double base, double growth) {
  CameraConfig camera = CameraConfig::make("ideal");
  camera.width = 640;
  camera.height = 480;
  camera.depth_max_m = 60.0;
  camera.noise = {.enabled = true, .sigma_base_m = base, .sigma_per_m2 = growth, .dropout_share = 0.0};
  return camera;
}

cv::Mat plane(const CameraConfig& camera, double z) { return {camera.height, camera.width, CV_32FC1, cv::Scalar(z)}; }

cv::Mat reading(const CameraConfig& camera, double z, std::uint64_t seed, const std::string& sensor, Stamp stamp) {
  cv::Mat depth = plane(camera, z);
  DepthNoiseModel(camera, seed, sensor).apply(depth, stamp);
  return depth;
}

std::vector<double> errors(const cv::Mat& depth, double z) {
  std::vector<double> out;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) out.push_back(static_cast<double>(depth.at<float>(v, u)) - z);
  }
  return out;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(DepthNoise, StandardDeviationGrowsAsDeclared) {
  const CameraConfig camera = open_camera(0.0005, 0.0005);
  for (const double z : {1.0, 1.7, 2.5, 3.8}) {
    const std::vector<double> e = errors(reading(camera, z, 1, "camera", 7), z);
    // Rounding to millimetres adds the variance of a uniform distribution one step wide.
    const double sigma = 0.0005 + 0.0005 * z * z;
    const double ratio = test::sample_variance(e) / (sigma * sigma + 1e-6 / 12);
    EXPECT_GT(ratio, test::variance_ratio_low(e.size())) << z;
    EXPECT_LT(ratio, test::variance_ratio_high(e.size())) << z;
    EXPECT_LT(std::abs(test::sample_mean(e)), 2.576 * sigma / std::sqrt(static_cast<double>(e.size()))) << z;
  }
}

TEST(DepthNoise, ErrorIsNormalIntoItsTails) {
  const CameraConfig camera = open_camera(1.0, 0.0);
  std::vector<double> all;
  for (Stamp stamp = 0; stamp < 4; ++stamp) {
    const std::vector<double> e = errors(reading(camera, 30.0, 3, "camera", stamp), 30.0);
    all.insert(all.end(), e.begin(), e.end());
  }
  // A step is a thousandth of the deviation: it moves the distribution by 0.0002 at most.
  EXPECT_LT(test::ks_distance(all, test::normal_cdf), 1.63 / std::sqrt(static_cast<double>(all.size())) + 2e-4);
  for (const double limit : {2.7, 3.5, 4.0}) {
    for (const double side : {-1.0, 1.0}) {
      const double expected = test::normal_cdf(-limit) * static_cast<double>(all.size());
      const auto found = static_cast<double>(std::count_if(all.begin(), all.end(), [&](double e) { return side * e > limit; }));
      EXPECT_NEAR(found, expected, 3.3 * std::sqrt(expected)) << side * limit;
    }
  }
}

TEST(DepthNoise, PixelsStampsSensorsAndSeedsAreIndependent) {
  const CameraConfig camera = open_camera(0.1, 0.0);
  const auto sample = [&](std::uint64_t seed, const std::string& sensor, Stamp stamp) {
    return errors(reading(camera, 10.0, seed, sensor, stamp), 10.0);
  };
  const std::vector<double> one = sample(1, "camera", 0);
  const double bound = 3.3 / std::sqrt(static_cast<double>(one.size()));
  EXPECT_LT(std::abs(test::correlation(one, sample(1, "camera", 1))), bound);
  EXPECT_LT(std::abs(test::correlation(one, sample(1, "camera2", 0))), bound);
  EXPECT_LT(std::abs(test::correlation(one, sample(2, "camera", 0))), bound);
  for (const std::size_t lag : {1u, 2u, 3u, 4u, 512u, 640u}) {
    const std::vector<double> early(one.begin(), one.end() - static_cast<std::ptrdiff_t>(lag));
    const std::vector<double> late(one.begin() + static_cast<std::ptrdiff_t>(lag), one.end());
    EXPECT_LT(std::abs(test::correlation(early, late)), bound) << lag;
  }
}

TEST(DepthNoise, DropoutTakesItsShareWhateverTheError) {
  CameraConfig camera = open_camera(0.1, 0.0);
  camera.noise.dropout_share = 0.05;
  const cv::Mat depth = reading(camera, 10.0, 1, "camera", 0);
  const auto n = static_cast<double>(depth.total());
  const double dropped = n - cv::countNonZero(depth);
  EXPECT_NEAR(dropped, 0.05 * n, 2.576 * std::sqrt(n * 0.05 * 0.95));
  // The others keep the error they had without dropout.
  camera.noise.dropout_share = 0.0;
  const cv::Mat whole = reading(camera, 10.0, 1, "camera", 0);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (depth.at<float>(v, u) != 0) {
        ASSERT_EQ(depth.at<float>(v, u), whole.at<float>(v, u));
      }
    }
  }
  camera.noise.dropout_share = 1.0;
  EXPECT_EQ(cv::countNonZero(reading(camera, 10.0, 1, "camera", 0)), 0);
}

TEST(DepthNoise, ReadingsAreTheFloatsOfWholeMillimetres) {
  const CameraConfig camera = open_camera(0.0005, 0.0005);
  const cv::Mat depth = reading(camera, 2.3456, 1, "camera", 0);
  EXPECT_TRUE(same_bytes(depth, depth_from_millimetres(depth_to_millimetres(depth))));
}

TEST(DepthNoise, WithoutNoiseEncodingFieldAndRangeRemain) {
  CameraConfig camera;
  camera.noise.enabled = false;
  cv::Mat depth(camera.height, camera.width, CV_32FC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) depth.at<float>(v, u) = 0.3f + 0.0031f * static_cast<float>(u);
  }
  const cv::Mat encoded = depth_from_millimetres(depth_to_millimetres(depth));
  DepthNoiseModel(camera, 1, "camera").apply(depth, 0);
  int kept = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = encoded.at<float>(v, u);
      const bool expected = in_depth_field(camera.field, camera.intrinsics().ray(u, v)) && z >= 0.5f && z <= 3.86f;
      ASSERT_EQ(depth.at<float>(v, u), expected ? z : 0.0f) << u << " " << v;
      kept += expected;
    }
  }
  EXPECT_GT(kept, 100000);
}

TEST(DepthNoise, NothingMeasuredWhereNothingIs) {
  const CameraConfig camera = open_camera(0.5, 0.0);
  cv::Mat depth = plane(camera, 0.0);
  depth.at<float>(1, 1) = std::numeric_limits<float>::quiet_NaN();
  depth.at<float>(1, 2) = std::numeric_limits<float>::infinity();
  depth.at<float>(1, 3) = -2.0f;
  depth.at<float>(1, 4) = 1e30f;
  DepthNoiseModel(camera, 1, "camera").apply(depth, 0);
  EXPECT_EQ(cv::countNonZero(depth), 0);
}

TEST(DepthNoise, APixelDependsOnItselfAloneAtAnyThreadCount) {
  CameraConfig camera = open_camera(0.01, 0.001);
  camera.width = 641;  // odd, so that rows and blocks do not line up
  camera.noise.dropout_share = 0.01;
  const cv::Mat whole = reading(camera, 5.0, 9, "camera", 11);
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    EXPECT_TRUE(same_bytes(whole, reading(camera, 5.0, 9, "camera", 11))) << threads;
  }
  set_thread_count(0);
  cv::Mat half = plane(camera, 5.0);
  for (int v = 0; v < half.rows; ++v) {
    for (int u = v % 2; u < half.cols; u += 2) half.at<float>(v, u) = 1.0f;
  }
  DepthNoiseModel(camera, 9, "camera").apply(half, 11);
  for (int v = 0; v < half.rows; ++v) {
    for (int u = 1 - v % 2; u < half.cols; u += 2) ASSERT_EQ(half.at<float>(v, u), whole.at<float>(v, u));
  }
}

Eigen::Vector3d direction(double right_deg, double down_deg) {
  return {std::tan(to_radians(right_deg)), std::tan(to_radians(down_deg)), 1.0};
}

TEST(DepthField, HasTheHexagonsShapeAndTilt) {
  DepthField field;
  field.tilt_down_deg = 0;
  EXPECT_TRUE(in_depth_field(field, direction(37.4, 0)));
  EXPECT_FALSE(in_depth_field(field, direction(37.6, 0)));
  EXPECT_TRUE(in_depth_field(field, direction(0, 32.4)));
  EXPECT_FALSE(in_depth_field(field, direction(0, -32.6)));
  EXPECT_FALSE(in_depth_field(field, direction(30, 32)));
  // Half as wide at the top: tan(20.99 deg) = tan(37.5 deg) / 2.
  EXPECT_TRUE(in_depth_field(field, direction(20.8, -32.4)));
  EXPECT_FALSE(in_depth_field(field, direction(21.2, -32.4)));
  EXPECT_FALSE(in_depth_field(field, {0, 0, -1}));
  field.shape = "rectangle";
  EXPECT_TRUE(in_depth_field(field, direction(37.4, 32.4)));
  field.tilt_down_deg = 6;
  EXPECT_TRUE(in_depth_field(field, direction(0, 38.4)));
  EXPECT_FALSE(in_depth_field(field, direction(0, 38.6)));
  EXPECT_TRUE(in_depth_field(field, direction(0, -26.4)));
  EXPECT_FALSE(in_depth_field(field, direction(0, -26.6)));
}

}  // namespace
}  // namespace waretwin
