#include "sensors/colour_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <opencv2/core.hpp>

#include "core/fields.h"
#include "core/parallel.h"
#include "sensors/rectification.h"
#include "sensors/tone_curve.h"
#include "tests/support/expect_error.h"
#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

CameraConfig ideal_camera(int width = 320, int height = 180) {
  CameraConfig camera = CameraConfig::make("ideal");
  camera.width = width;
  camera.height = height;
  return camera;
}

cv::Mat even(const CameraConfig& camera, double red, double green, double blue) {
  return {camera.height, camera.width, CV_32FC4, cv::Scalar(red, green, blue, 0)};
}

// Red grows along rows, green along columns.
cv::Mat ramps(const CameraConfig& camera) {
  cv::Mat out(camera.height, camera.width, CV_32FC4);
  for (int v = 0; v < out.rows; ++v) {
    for (int u = 0; u < out.cols; ++u) {
      out.at<cv::Vec4f>(v, u) = {0.01f * static_cast<float>(u), 0.02f * static_cast<float>(v), 0.3f, 0.0f};
    }
  }
  return out;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

std::vector<double> channel(const cv::Mat& sensed, int c) {
  std::vector<double> out;
  for (int v = 0; v < sensed.rows; ++v) {
    for (int u = 0; u < sensed.cols; ++u) out.push_back(static_cast<double>(sensed.at<cv::Vec3f>(v, u)[c]));
  }
  return out;
}

TEST(ColourModel, WithoutEffectsItIsTheToneCurve) {
  const CameraConfig camera = ideal_camera();
  const cv::Mat radiance = ramps(camera), picture = ColourModel(camera, 1, "camera").picture(radiance, 5);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(picture.at<cv::Vec3b>(v, u)[2 - c], tone_mapped(radiance.at<cv::Vec4f>(v, u)[c])) << u << " " << v << " " << c;
      }
    }
  }
}

TEST(ColourModel, EachSwitchBringsItsOwnEffectAlone) {
  const CameraConfig ideal = ideal_camera();
  const cv::Mat radiance = ramps(ideal), plain = ColourModel(ideal, 1, "camera").picture(radiance, 5);
  for (bool ColourConfig::*effect : {&ColourConfig::noise, &ColourConfig::vignetting, &ColourConfig::white_balance}) {
    CameraConfig camera = ideal;
    camera.colour.*effect = true;
    EXPECT_FALSE(same_bytes(ColourModel(camera, 1, "camera").picture(radiance, 5), plain));
  }
  // What is not the sensor's business leaves it alone, and an effect of no size is none.
  CameraConfig camera = ideal;
  camera.colour.lens_distortion = camera.colour.rolling_shutter = camera.colour.motion_blur = true;
  EXPECT_TRUE(same_bytes(ColourModel(camera, 1, "camera").picture(radiance, 5), plain));
  camera.colour.vignetting = camera.colour.white_balance = true;
  camera.colour.vignetting_strength = camera.colour.white_balance_error = 0.0;
  EXPECT_TRUE(same_bytes(ColourModel(camera, 1, "camera").picture(radiance, 5), plain));
}

TEST(ColourModel, VarianceIsShotAndReadNoise) {
  CameraConfig camera = ideal_camera(640, 360);
  camera.colour.noise = true;
  const double white = camera.colour.electrons_at_white(), read = camera.colour.read_noise_e;
  EXPECT_EQ(white, 2000.0);
  const ColourModel model(camera, 1, "camera");
  // Seven brightnesses, three colours each: at 99 % a bin, all 21 hold with 81 %; the bounds are widened to 99.95 % a bin, 99 % for all.
  constexpr double kDeviations = 3.48;
  Stamp stamp = 0;
  for (const double radiance : {0.0, 0.002, 0.01, 0.05, 0.2, 1.0, 4.0}) {
    const cv::Mat sensed = model.sensed(even(camera, radiance, 0.5 * radiance, 2.0 * radiance), ++stamp);
    const double of_channel[3] = {radiance, 0.5 * radiance, 2.0 * radiance};
    for (int c = 0; c < 3; ++c) {
      const std::vector<double> x = channel(sensed, c);
      const double electrons = of_channel[c] * white;
      const double expected = (electrons + read * read) / (white * white);
      EXPECT_NEAR(camera.colour.variance(of_channel[c]), expected, 1e-12);
      const double ratio = test::sample_variance(x) / expected;
      EXPECT_GT(ratio, test::chi_square_ratio(x.size(), -kDeviations)) << radiance << " " << c;
      EXPECT_LT(ratio, test::chi_square_ratio(x.size(), kDeviations)) << radiance << " " << c;
      EXPECT_LT(std::abs(test::sample_mean(x) - of_channel[c]), kDeviations * std::sqrt(expected / static_cast<double>(x.size())) + 1e-6)
          << radiance << " " << c;
    }
  }
}

TEST(ColourModel, NoiseIsNormalAndIndependentBetweenPixelsColoursAndFrames) {
  CameraConfig camera = ideal_camera(640, 360);
  camera.colour.noise = true;
  const ColourModel model(camera, 1, "camera");
  const cv::Mat grey = even(camera, 0.5, 0.5, 0.5);
  const cv::Mat first = model.sensed(grey, 1), second = model.sensed(grey, 2);
  const double deviation = std::sqrt(camera.colour.variance(0.5));
  const std::vector<double> red = channel(first, 0), green = channel(first, 1), later = channel(second, 0);
  const auto n = static_cast<double>(red.size());
  EXPECT_LT(test::ks_distance(red, [&](double x) { return test::normal_cdf((x - 0.5) / deviation); }), 1.63 / std::sqrt(n));
  const std::vector<double> left(red.begin(), red.end() - 1), right(red.begin() + 1, red.end());
  EXPECT_LT(std::abs(test::correlation(left, right)), 2.576 / std::sqrt(n));
  EXPECT_LT(std::abs(test::correlation(red, green)), 2.576 / std::sqrt(n));
  EXPECT_LT(std::abs(test::correlation(red, later)), 2.576 / std::sqrt(n));
}

TEST(ColourModel, ShorterExposuresAreNoisierAndWellsOverflow) {
  CameraConfig camera = ideal_camera();
  camera.colour.noise = true;
  const auto variance = [&] {
    return test::sample_variance(channel(ColourModel(camera, 1, "camera").sensed(even(camera, 1, 1, 1), 3), 0));
  };
  const double longer = variance();
  camera.colour.exposure_s /= 4.0;
  // 57600 values each: a ratio of two such variances is known to 2 %.
  EXPECT_NEAR(variance() / longer, (500.0 + 16.0) / (500.0 * 500.0) / ((2000.0 + 16.0) / (2000.0 * 2000.0)), 0.1);
  camera.colour.exposure_s *= 4.0;
  camera.colour.full_well_e = 3000.0;
  const std::vector<double> full = channel(ColourModel(camera, 1, "camera").sensed(even(camera, 5, 5, 5), 3), 0);
  for (const double value : full) ASSERT_NEAR(value, 1.5, 1e-6);
}

TEST(ColourModel, CornersDarkenWithTheFourthPowerOfTheCosine) {
  CameraConfig camera = ideal_camera(321, 181);
  camera.colour.vignetting = true;
  const Intrinsics k = camera.intrinsics();
  for (const double strength : {1.0, 0.3}) {
    camera.colour.vignetting_strength = strength;
    const cv::Mat sensed = ColourModel(camera, 1, "camera").sensed(even(camera, 2, 1, 0.5), 1);
    for (int v = 0; v < camera.height; v += 9) {
      for (int u = 0; u < camera.width; u += 8) {
        const double cosine = 1.0 / k.ray(u, v).norm();
        const double expected = 1.0 - strength * (1.0 - std::pow(cosine, 4));
        ASSERT_NEAR(sensed.at<cv::Vec3f>(v, u)[0], 2 * expected, 1e-5);
        ASSERT_NEAR(sensed.at<cv::Vec3f>(v, u)[2], 0.5 * expected, 1e-5);
      }
    }
    EXPECT_NEAR(sensed.at<cv::Vec3f>(90, 160)[1], 1.0, 1e-6);
  }
}

TEST(ColourModel, WhiteBalanceIsDrawnOncePerRun) {
  CameraConfig camera = ideal_camera(64, 48);
  camera.colour.white_balance = true;
  std::vector<double> errors;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const ColourModel model(camera, seed, "camera");
    EXPECT_EQ(model.white_balance()[1], 1.0f);
    for (const int c : {0, 2}) errors.push_back((static_cast<double>(model.white_balance()[c]) - 1.0) / camera.colour.white_balance_error);
    if (seed > 3) continue;
    const cv::Mat first = model.sensed(even(camera, 0.8, 0.8, 0.8), 1), later = model.sensed(even(camera, 0.8, 0.8, 0.8), 99);
    EXPECT_TRUE(same_bytes(first, later));
    EXPECT_NEAR(first.at<cv::Vec3f>(5, 7)[0], 0.8 * static_cast<double>(model.white_balance()[0]), 1e-6);
    EXPECT_NEAR(first.at<cv::Vec3f>(5, 7)[2], 0.8 * static_cast<double>(model.white_balance()[2]), 1e-6);
  }
  EXPECT_LT(test::ks_distance(errors, [](double x) { return 0.5 * (x + 1.0); }), 1.63 / std::sqrt(static_cast<double>(errors.size())));
}

TEST(ColourModel, PixelDependsOnItsOwnKeyAtAnyThreadCount) {
  CameraConfig camera;
  camera.width = 333;
  camera.height = 187;
  const cv::Mat radiance = ramps(camera);
  std::vector<cv::Mat> pictures;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    pictures.push_back(ColourModel(camera, 7, "camera").picture(radiance, 3));
  }
  set_thread_count(0);
  EXPECT_TRUE(same_bytes(pictures[0], pictures[1]));
  EXPECT_TRUE(same_bytes(pictures[0], pictures[2]));
  EXPECT_FALSE(same_bytes(pictures[0], ColourModel(camera, 8, "camera").picture(radiance, 3)));
  EXPECT_FALSE(same_bytes(pictures[0], ColourModel(camera, 7, "other").picture(radiance, 3)));
  EXPECT_FALSE(same_bytes(pictures[0], ColourModel(camera, 7, "camera").picture(radiance, 4)));
  // Another pixel's light changes nothing here.
  cv::Mat other = radiance.clone();
  other.at<cv::Vec4f>(20, 30) = {3, 3, 3, 0};
  cv::Mat picture = ColourModel(camera, 7, "camera").picture(other, 3);
  EXPECT_NE(picture.at<cv::Vec3b>(20, 30), pictures[0].at<cv::Vec3b>(20, 30));
  picture.at<cv::Vec3b>(20, 30) = pictures[0].at<cv::Vec3b>(20, 30);
  EXPECT_TRUE(same_bytes(picture, pictures[0]));
}

TEST(ToneCurve, ManyAtOnceAreThoseOfOne) {
  std::vector<float> values = {0.0f, -1.0f, std::nanf(""), 1e9f, INFINITY};
  for (int i = 0; i < 5000; ++i) values.push_back(std::ldexp(1.0f + 0.37f * static_cast<float>(i % 3), i % 40 - 20));
  std::vector<std::uint8_t> toned(values.size());
  tone_mapped(values.data(), values.size(), toned.data());
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(toned[i], tone_mapped(values[i])) << values[i];
}

TEST(ColourLens, ImageHoldsThePinholeViewAndNothingFolds) {
  const CameraConfig camera;
  const Lens lens = camera.colour_lens();
  const Intrinsics k = camera.intrinsics();
  double closest = 1e9;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; u += v == 0 || v == camera.height - 1 ? 1 : camera.width - 1) {
      const auto pixel = lens.project(k.ray(u, v));
      ASSERT_TRUE(pixel);
      const double inside = std::min({pixel->x(), camera.width - 1 - pixel->x(), pixel->y(), camera.height - 1 - pixel->y()});
      ASSERT_GT(inside, -1e-9);
      closest = std::min(closest, inside);
    }
  }
  EXPECT_NEAR(closest, 0.0, 1e-9);  // no longer lens would do
  // Outwards, every step moves outwards, farther than the image's corners reach.
  double before = 0.0;
  for (double r = 0.0; r < 1.6; r += 0.001) {
    const double now = lens.distortion().apply({0.8 * r, 0.6 * r}).norm();
    ASSERT_TRUE(r == 0.0 || now > before) << r;
    before = now;
  }
  // How far the corners are from where a pinhole of the same focal length would have them.
  const Lens pinhole(lens.intrinsics());
  for (const auto& [u, v] : {std::pair{0, 0}, {camera.width - 1, 0}, {0, camera.height - 1}, {camera.width - 1, camera.height - 1}}) {
    const double shift = (*lens.project(k.ray(u, v)) - *pinhole.project(k.ray(u, v))).norm();
    EXPECT_GT(shift, 35.0);
    EXPECT_LT(shift, 50.0);
  }
}

TEST(ColourLens, IdealPresetsAndSwitchesArePinholes) {
  CameraConfig camera;
  EXPECT_TRUE(camera.view().distortion().is_none());
  camera.colour.rectify = false;
  EXPECT_FALSE(camera.view().distortion().is_none());
  camera.colour.lens_distortion = false;
  EXPECT_TRUE(camera.view().distortion().is_none());
  EXPECT_EQ(camera.colour_lens().intrinsics().fx, camera.intrinsics().fx);
  for (const char* preset : {"ideal", "azure_kinect_gaussian"}) EXPECT_TRUE(CameraConfig::make(preset).colour.is_ideal());
  for (const char* preset : {"azure_kinect", "femto_bolt"}) {
    const ColourConfig colour = CameraConfig::make(preset).colour;
    EXPECT_TRUE(colour.lens_distortion && colour.rolling_shutter && colour.motion_blur && colour.noise && colour.vignetting &&
                colour.white_balance);
  }
}

TEST(ColourLens, RejectsOneThatFoldsOver) {
  CameraConfig camera;
  camera.colour.lens = {.k1 = -0.9};
  EXPECT_ERROR(camera.colour_lens(), "colour.lens", "folds over");
}

TEST(Rectification, ResamplesAtTheLensProjection) {
  CameraConfig camera;
  camera.width = 320;
  camera.height = 180;
  const Lens lens = camera.colour_lens();
  const Intrinsics k = camera.intrinsics();
  const Rectification rectification(lens, k);
  // A picture whose colours name the place: linear, so that bilinear resampling is exact but for the rounding.
  cv::Mat taken(180, 320, CV_8UC3), labels(180, 320, CV_16UC1);
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 320; ++u) {
      taken.at<cv::Vec3b>(v, u) = {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(u / 2), 200};
      labels.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(v * 320 + u);
    }
  }
  const cv::Mat colour = rectification.colour(taken), label = rectification.labels(labels);
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector2d pixel = *lens.project(k.ray(u, v));
      const cv::Vec3b seen = colour.at<cv::Vec3b>(v, u);
      ASSERT_NEAR(seen[0], pixel.y(), 0.51);
      ASSERT_EQ(seen[2], 200);
      const int from = label.at<std::uint16_t>(v, u);
      ASSERT_NEAR(from % 320, pixel.x(), 0.503);  // weights are known to 1/256 of a pixel
      ASSERT_NEAR(from / 320, pixel.y(), 0.503);
      ASSERT_EQ(rectification.nearest(u, v), cv::Point(from % 320, from / 320));
    }
  }
}

}  // namespace
}  // namespace waretwin
