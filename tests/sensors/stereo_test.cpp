#include "sensors/stereo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>

#include "core/config.h"
#include "core/parallel.h"
#include "core/random.h"
#include "tests/support/expect_error.h"
#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

// A wall straight ahead: everything the same in every pixel.
StereoSignal even(double depth, double ambient = 0.5, double dots = 0.5, cv::Size size = {848, 480}) {
  return {{size, CV_32FC1, cv::Scalar(depth)},
          {size, CV_32FC1, cv::Scalar(ambient)},
          {size, CV_32FC1, cv::Scalar(dots)},
          {size, CV_8UC1, cv::Scalar(1)}};
}

CameraConfig d435() { return CameraConfig::make("realsense_d435"); }

// Everything off but what a test asks for.
CameraConfig quiet() {
  CameraConfig camera = d435();
  auto& s = camera.stereo;
  s.occlusion = s.fattening = s.texture = s.noise = s.calibration = s.quantisation = false;
  return camera;
}

int readings(const CameraConfig& camera, const StereoSignal& signal) {
  return cv::countNonZero(StereoModel(camera, 1, "camera").read(signal, 0));
}

TEST(Stereo, WithoutErrorsDepthIsTrueToTheMillimetre) {
  const StereoModel model(quiet(), 1, "camera");
  for (const double depth : {0.2, 0.7654, 1.0, 2.3456, 9.9}) {
    const cv::Mat out = model.read(even(depth), 0);
    int seen = 0;
    for (int v = 0; v < out.rows; ++v) {
      for (int u = 0; u < out.cols; ++u) {
        const float z = out.at<float>(v, u);
        if (model.rays().at<cv::Vec3f>(v, u)[2] == 0.0f) {
          ASSERT_EQ(z, 0.0f);
          continue;
        }
        ASSERT_NEAR(z, depth, 0.00051);
        ASSERT_EQ(z, std::nearbyint(z * 1000.0f) * 0.001f);
        ++seen;
      }
    }
    // 87 x 58 deg of the 90 x 59.0 deg of the picture.
    EXPECT_NEAR(seen, 848.0 * 480.0 * std::tan(to_radians(43.5)) * std::tan(to_radians(29.0)) * 424.0 / 240.0, 1500) << depth;
  }
}

// In disparities the error is normal with the declared deviation; in depth it grows with z^2 / (f B).
TEST(Stereo, DeviationFollowsTheDeclaredLaw) {
  CameraConfig camera = quiet();
  camera.stereo.noise = camera.stereo.texture = true;
  camera.stereo.correlation = false;
  const StereoConfig& config = camera.stereo;
  const StereoModel model(camera, 5, "camera");
  const double scale = config.depth_times_disparity();
  Stamp stamp = 0;
  for (const double depth : {0.5, 1.0, 1.5, 2.0, 3.0, 5.0}) {
    for (const double dots : {0.5, 0.02, 0.007}) {
      const double contrast = config.texture_of(0.0, config.ambient * 0.5, dots);
      ASSERT_GT(contrast, config.min_texture);
      const cv::Mat out = model.read(even(depth, 0.5, dots), ++stamp);
      std::vector<double> disparity_errors, depths;
      for (int v = 0; v < out.rows; ++v) {
        for (int u = 0; u < out.cols; ++u) {
          const double z = out.at<float>(v, u);
          if (z == 0.0) continue;
          disparity_errors.push_back(scale / z - scale / depth);
          depths.push_back(z);
        }
      }
      ASSERT_GT(depths.size(), 370000u);
      // Millimetres add their own variance.
      const double sigma = config.disparity_deviation(contrast), step = 0.001 * scale / (depth * depth);
      const double variance = sigma * sigma + step * step / 12.0;
      const double ratio = test::sample_variance(disparity_errors) / variance;
      EXPECT_GT(ratio, test::variance_ratio_low(depths.size()) - 0.001) << depth << " " << dots;
      EXPECT_LT(ratio, test::variance_ratio_high(depths.size()) + 0.001) << depth << " " << dots;
      EXPECT_LT(std::abs(test::sample_mean(disparity_errors)), 2.8 * std::sqrt(variance / static_cast<double>(depths.size())) + 1e-5);
      // One over a normal number is normal while its deviation is small.
      const double relative = sigma * depth / scale;
      const double depth_sigma = config.depth_deviation(depth, contrast);
      EXPECT_NEAR(depth_sigma, depth * depth * sigma / (424.0 * 0.05), 1e-12);
      EXPECT_NEAR(std::sqrt(test::sample_variance(depths) / (depth_sigma * depth_sigma + 1e-6 / 12.0)), 1.0,
                  0.004 + 8.0 * relative * relative)
          << depth << " " << dots;
    }
  }
}

TEST(Stereo, DeviationIsThatOfTheProduct) {
  const StereoConfig config;
  const auto bright = [&](double z) { return config.texture_of(0.0, 0.6 * 0.8 * config.ambient, 0.8 / (z * z)); };
  // A white wall at 2 m: 0.08 px are 15 mm; the maker promises 2 % of the depth, fixed and random error together.
  EXPECT_NEAR(config.depth_deviation(2.0, bright(2.0)), 0.0151, 0.0003);
  EXPECT_LT(4.0 * config.calibration_px / config.depth_times_disparity() + config.depth_deviation(2.0, bright(2.0)), 0.04);
  // Readings on white walls end near 10 m, on dark rubber before 3 m.
  EXPECT_GT(bright(7.0), config.min_texture);
  const auto rubber = [&](double z) { return config.texture_of(0.0, 0.04 * config.ambient, 0.04 / (z * z)); };
  EXPECT_GT(rubber(2.0), config.min_texture);
  EXPECT_LT(rubber(3.0), config.min_texture);
}

TEST(Stereo, NeighboursShareTheErrorsOfTheirWindows) {
  CameraConfig camera = quiet();
  camera.stereo.noise = true;
  const StereoModel model(camera, 3, "camera");
  const double depth = 1.0, scale = camera.stereo.depth_times_disparity();
  const cv::Mat out = model.read(even(depth), 7);
  const auto correlation = [&](int dx, int dy) {
    std::vector<double> a, b;
    for (int v = 10; v < 460; ++v) {
      for (int u = 30; u < 800; ++u) {
        a.push_back(scale / out.at<float>(v, u) - scale / depth);
        b.push_back(scale / out.at<float>(v + dy, u + dx) - scale / depth);
      }
    }
    return test::correlation(a, b);
  };
  // Of 346,500 pixels one in 36 (the sum of the squared correlations) counts: deviation 0.0102. The noise of the millimetres (0.0061 px
  // of 0.08) takes 0.6 % off.
  for (const auto& [dx, dy] : {std::pair{1, 0}, {3, 0}, {0, 4}, {5, 5}, {8, 0}, {9, 0}, {0, 12}}) {
    const double expected = std::max(0.0, 1.0 - dx / 9.0) * std::max(0.0, 1.0 - dy / 9.0);
    EXPECT_NEAR(correlation(dx, dy), expected, 0.006 + 2.576 * 0.0102) << dx << " " << dy;
  }
  std::vector<double> apart;
  for (Stamp stamp = 0; stamp < 4; ++stamp) {
    const cv::Mat next = model.read(even(depth), stamp);
    for (int v = 10; v < 470; v += 9) {
      for (int u = 30; u < 810; u += 9) apart.push_back(scale / next.at<float>(v, u) - scale / depth);
    }
  }
  const double ratio = test::sample_variance(apart) / (0.08 * 0.08 + std::pow(0.001 * scale, 2) / 12.0);
  EXPECT_GT(ratio, test::variance_ratio_low(apart.size()));
  EXPECT_LT(ratio, test::variance_ratio_high(apart.size()));
}

TEST(Stereo, DisparitiesComeInSteps) {
  CameraConfig camera = quiet();
  camera.stereo.quantisation = true;
  const StereoModel model(camera, 1, "camera");
  const double scale = camera.stereo.depth_times_disparity();
  StereoSignal signal = even(1.0);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 848; ++u) signal.depth.at<float>(v, u) = 0.5f + 0.01f * static_cast<float>(u);
  }
  const cv::Mat out = model.read(signal, 0);
  for (int u = 30; u < 810; ++u) {
    const double step = std::nearbyint(32.0 * scale / (0.5 + 0.01 * u)) / 32.0;
    ASSERT_NEAR(out.at<float>(240, u), scale / step, 0.00051) << u;
  }
  // At 4 m the steps are 24 mm.
  const double at4 = 16.0 / scale / 32.0;
  EXPECT_NEAR(at4, 0.0236, 0.0001);
}

TEST(Stereo, TheSearchEndsNearAndFar) {
  CameraConfig camera = quiet();
  camera.depth_min_m = 0.1;
  const int all = readings(camera, even(1.0));
  EXPECT_GT(all, 370000);
  // 21.2 px m / 126 px.
  EXPECT_EQ(readings(camera, even(0.167)), 0);
  EXPECT_EQ(readings(camera, even(0.170)), all);
  EXPECT_EQ(readings(camera, even(10.1)), 0);
  EXPECT_EQ(readings(camera, even(0.0)), 0);
  EXPECT_EQ(readings(camera, even(std::numeric_limits<double>::quiet_NaN())), 0);
  camera.stereo.disparity_shift_px = 20.0;
  EXPECT_EQ(readings(camera, even(0.146)), all);
  EXPECT_EQ(readings(camera, even(1.05)), all);
  EXPECT_EQ(readings(camera, even(1.07)), 0);
  camera.stereo.disparity_shift_px = 0.0;
  camera.depth_min_m = 0.19;
  EXPECT_EQ(readings(camera, even(0.18)), 0);
}

TEST(Stereo, WithoutTextureThereIsNoReading) {
  CameraConfig camera = quiet();
  camera.stereo.texture = true;
  const int all = readings(camera, even(1.0, 0.5, 0.5));
  EXPECT_GT(all, 370000);
  // The contrast at which readings end, found in the declared law.
  double dots = 1.0;
  while (camera.stereo.texture_of(0.0, 0.5 * camera.stereo.ambient, dots) > camera.stereo.min_texture) dots *= 0.999;
  EXPECT_EQ(readings(camera, even(1.0, 0.5, 1.01 * dots)), all);
  EXPECT_EQ(readings(camera, even(1.0, 0.5, 0.99 * dots)), 0);
  // Sunlight drowns the dots; so does a saturated picture.
  EXPECT_EQ(readings(camera, even(3.0, 0.5, 0.5 / 9.0)), all);
  camera.stereo.ambient = 20.0;
  EXPECT_EQ(readings(camera, even(1.5, 0.5, 0.5 / 2.25)), 0);
  camera.stereo.ambient = 0.2;
  EXPECT_EQ(readings(camera, even(3.0, 0.5, 1.01 * camera.stereo.white())), 0);
  camera.stereo.projector = false;
  EXPECT_EQ(readings(camera, even(1.0, 0.5, 0.5)), 0);
  camera.stereo.texture = false;
  EXPECT_EQ(readings(camera, even(1.0, 0.5, 0.5)), all);
}

TEST(Stereo, OnlyWhatChangesAlongARowIsTexture) {
  CameraConfig camera = quiet();
  camera.stereo.texture = true;
  camera.stereo.projector = false;
  StereoSignal across = even(1.0), down = even(1.0), edge = even(1.0);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 848; ++u) {
      across.ambient.at<float>(v, u) = u % 4 < 2 ? 0.3f : 0.6f;
      down.ambient.at<float>(v, u) = v % 4 < 2 ? 0.3f : 0.6f;
      edge.ambient.at<float>(v, u) = u < 424 ? 0.3f : 0.6f;
    }
  }
  EXPECT_GT(readings(camera, across), 370000);
  EXPECT_EQ(readings(camera, down), 0);
  // Windows of 9 pixels that hold the edge between columns 423 and 424.
  const cv::Mat depth = StereoModel(camera, 1, "camera").read(edge, 0);
  for (int u = 400; u < 450; ++u) EXPECT_EQ(depth.at<float>(200, u) > 0.0f, u >= 420 && u <= 427) << u;
}

TEST(Stereo, TextureIsThatOfTheSlowReference) {
  CameraConfig camera = quiet();
  camera.stereo.width = 61;
  camera.stereo.height = 43;
  camera.stereo.window_px = 7;
  const StereoConfig& config = camera.stereo;
  const StereoModel model(camera, 1, "camera");
  StereoSignal signal = even(1.0, 0.0, 0.0, {61, 43});
  const RandomStream random(3, "test", "pictures");
  for (int v = 0; v < 43; ++v) {
    for (int u = 0; u < 61; ++u) {
      const auto [a, b] = random.uniform_pair(static_cast<std::uint64_t>(v * 61 + u));
      signal.ambient.at<float>(v, u) = a;
      signal.dots.at<float>(v, u) = 0.1f * b;
    }
  }
  const cv::Mat texture = model.texture(signal);
  for (int v = 0; v < 43; ++v) {
    for (int u = 0; u < 61; ++u) {
      double mean = 0.0, dots = 0.0, square = 0.0;
      for (int dv = -3; dv <= 3; ++dv) {
        const int row = std::clamp(v + dv, 0, 42);
        double row_mean = 0.0;
        for (int du = -3; du <= 3; ++du) {
          const int col = std::clamp(u + du, 0, 60);
          row_mean += signal.ambient.at<float>(row, col) / 7.0;
          dots += signal.dots.at<float>(row, col) / 49.0;
        }
        mean += row_mean / 7.0;
        for (int du = -3; du <= 3; ++du) square += std::pow(signal.ambient.at<float>(row, std::clamp(u + du, 0, 60)) - row_mean, 2) / 49.0;
      }
      const double expected = config.texture_of(config.ambient * std::sqrt(square), config.ambient * mean, dots);
      ASSERT_NEAR(texture.at<float>(v, u), expected, 1e-5 * expected) << u << " " << v;
    }
  }
}

// A square of columns 300..500, rows 150..300 at 1 m before a wall at 3 m.
StereoSignal square_before_wall() {
  StereoSignal signal = even(3.0);
  signal.depth(cv::Rect(300, 150, 201, 151)).setTo(1.0f);
  return signal;
}

TEST(Stereo, ForegroundsGrowByHalfAWindow) {
  CameraConfig camera = quiet();
  for (const bool fattening : {false, true}) {
    camera.stereo.fattening = fattening;
    const cv::Mat depth = StereoModel(camera, 1, "camera").read(square_before_wall(), 0);
    const int grown = fattening ? 4 : 0;
    for (int v = 100; v < 400; ++v) {
      for (int u = 250; u < 600; ++u) {
        const bool foreground = u >= 300 - grown && u <= 500 + grown && v >= 150 - grown && v <= 300 + grown;
        ASSERT_FLOAT_EQ(depth.at<float>(v, u), foreground ? 1.0f : 3.0f) << u << " " << v;
      }
    }
  }
}

// Disparities of a plane are even: 0.17 px a pixel is a wall 0.3 m beside the axis, steeper than anything in a usual picture.
TEST(Stereo, SlantedPlanesDoNotGrow) {
  CameraConfig camera = quiet();
  StereoSignal signal = even(1.0);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 848; ++u) signal.depth.at<float>(v, u) = static_cast<float>(21.2 / (5.0 + 0.1 * u + 0.02 * v));
  }
  const cv::Mat without = StereoModel(camera, 1, "camera").read(signal, 0);
  camera.stereo.fattening = true;
  const cv::Mat with = StereoModel(camera, 1, "camera").read(signal, 0);
  EXPECT_EQ(std::memcmp(with.data, without.data, with.total() * with.elemSize()), 0);
  EXPECT_GT(cv::countNonZero(with), 370000);
}

TEST(Stereo, WhatTheRightCameraDoesNotSeeIsAHoleUnlessTheForegroundGrowsOverIt) {
  CameraConfig camera = quiet();
  camera.stereo.occlusion = true;
  StereoSignal signal = square_before_wall();
  signal.seen(cv::Rect(286, 150, 14, 151)).setTo(0);
  const auto at = [&](int u) { return StereoModel(camera, 1, "camera").read(signal, 0).at<float>(200, u); };
  EXPECT_FLOAT_EQ(at(285), 3.0f);
  for (const int u : {286, 295, 296, 299}) EXPECT_EQ(at(u), 0.0f) << u;
  camera.stereo.fattening = true;
  for (const int u : {286, 295}) EXPECT_EQ(at(u), 0.0f) << u;
  for (const int u : {296, 299}) EXPECT_FLOAT_EQ(at(u), 1.0f) << u;
  camera.stereo.occlusion = false;
  EXPECT_FLOAT_EQ(at(286), 3.0f);
}

// A step of half a pixel of disparity hides half a pixel; one of three hides three, which no window reaches over.
TEST(Stereo, ShadowsOfSmallStepsAreBridged) {
  CameraConfig camera = quiet();
  camera.stereo.occlusion = camera.stereo.fattening = true;
  for (const double step : {0.5, 3.0}) {
    StereoSignal signal = even(21.2 / 10.0);
    signal.depth.colRange(400, 848).setTo(21.2 / (10.0 + step));
    const int width = step < 1.0 ? 1 : 3;
    signal.seen.colRange(400 - width, 400).setTo(0);
    const cv::Mat depth = StereoModel(camera, 1, "camera").read(signal, 0);
    // The foreground grows over the wide shadow, as it does over any within half a window.
    for (int u = 390; u < 410; ++u) {
      EXPECT_NEAR(depth.at<float>(240, u), 21.2 / (10.0 + (u >= (step < 1.0 ? 400 : 396) ? step : 0.0)), 0.00051) << step << " " << u;
    }
    camera.stereo.fattening = false;
    const cv::Mat plain = StereoModel(camera, 1, "camera").read(signal, 0);
    for (int u = 390; u < 410; ++u) EXPECT_EQ(plain.at<float>(240, u) == 0.0f, u >= 400 - width && u < 400) << u;
    camera.stereo.fattening = true;
  }
}

TEST(Stereo, TheCalibrationErrorStaysForTheRun) {
  CameraConfig camera = quiet();
  camera.stereo.calibration = true;
  const double bound = camera.stereo.calibration_px, scale = camera.stereo.depth_times_disparity();
  std::vector<double> errors;
  camera.stereo.width = camera.stereo.height = 16;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) errors.push_back(StereoModel(camera, seed, "camera").calibration_error_px());
  EXPECT_LT(test::ks_distance(errors, [&](double x) { return (x + bound) / (2.0 * bound); }), 1.63 / std::sqrt(1000.0));
  const StereoModel model(camera, 8, "camera");
  EXPECT_EQ(model.calibration_error_px(), StereoModel(camera, 8, "camera").calibration_error_px());
  EXPECT_NE(model.calibration_error_px(), StereoModel(camera, 8, "other").calibration_error_px());
  for (const Stamp stamp : {Stamp{0}, Stamp{1'000'000'000}}) {
    EXPECT_NEAR(model.read(even(2.0, 0.5, 0.5, {16, 16}), stamp).at<float>(8, 8), scale / (scale / 2.0 + model.calibration_error_px()),
                0.00051);
  }
  camera.stereo.calibration = false;
  EXPECT_EQ(StereoModel(camera, 8, "camera").calibration_error_px(), 0.0);
}

TEST(Stereo, ReadingsAreTheSameAtAnyThreadCount) {
  const StereoModel model(d435(), 9, "camera");
  const StereoSignal signal = square_before_wall();
  set_thread_count(1);
  const cv::Mat one = model.read(signal, 5);
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    const cv::Mat other = model.read(signal, 5);
    EXPECT_EQ(std::memcmp(one.data, other.data, one.total() * one.elemSize()), 0) << threads;
  }
  set_thread_count(0);
  const cv::Mat later = model.read(signal, 6);
  EXPECT_NE(std::memcmp(one.data, later.data, one.total() * one.elemSize()), 0);
}

TEST(StereoConfig, PresetComesBeforeItsKeysInAnyOrder) {
  const auto applied = [](const std::vector<Setting>& settings) {
    CameraConfig camera;
    camera.mount.z_m = 1.23;
    apply_settings(settings, [&](Fields& f) { camera.visit(f); });
    return camera;
  };
  for (const bool preset_first : {true, false}) {
    const Setting preset = {"preset", "realsense_d435"}, projector = {"stereo.projector", "false"}, nearest = {"depth_min_m", "0.3"};
    const CameraConfig camera = preset_first ? applied({preset, projector, nearest}) : applied({nearest, projector, preset});
    EXPECT_EQ(camera.depth_model, "stereo");
    EXPECT_EQ(camera.field.shape, "rectangle");
    EXPECT_FALSE(camera.stereo.projector);
    EXPECT_EQ(camera.depth_min_m, 0.3);
    EXPECT_EQ(camera.mount.z_m, 1.23);
    EXPECT_EQ(camera.depth_lens().intrinsics().width, 848);
    EXPECT_EQ(camera.X_CD().translation().x(), -0.015);
  }
  EXPECT_ERROR(applied({{"preset", "realsense_d435"}, {"depth_mode", "wfov_unbinned"}}), "depth_mode", "realsense_d435");
  EXPECT_ERROR(applied({{"stereo.window_px", "8"}}), "stereo.window_px", "odd");
  EXPECT_ERROR(CameraConfig::make("realsense_d999"), "realsense_d999", "realsense_d435");
}

}  // namespace
}  // namespace waretwin
