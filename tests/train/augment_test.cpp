#include "harness/train/augment.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "harness/train/epoch_loader.h"
#include "mapper/detect/resized_picture.h"

namespace waretwin::train {
namespace {

const cv::Size kSize(128, 64);

AugmentConfig only_geometry() {
  AugmentConfig config;
  config.hue_deg = config.saturation = config.exposure = config.blur = config.noise = config.cut_out = 0.0;
  return config;
}

// A white rectangle on black.
Sample white_box() {
  Sample sample{cv::Mat(80, 160, CV_8UC3, cv::Scalar::all(0)), {{0, {0.35f, 0.3f, 0.3f, 0.4f}, false}}};
  sample.picture(cv::Rect(56, 24, 48, 32)).setTo(cv::Scalar::all(255));
  return sample;
}

TEST(Augment, BoxesFollowWhatThePictureShows) {
  const RandomStream random(1, "augment_test", "dice");
  const Sample source = white_box();
  int checked = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Dice dice(random, i);
    const Sample sample = augmented([&](std::size_t) { return source; }, 1, 0, kSize, only_geometry(), false, dice);
    ASSERT_EQ(sample.picture.size(), kSize);
    cv::Mat claimed(kSize, CV_8U, cv::Scalar(0));
    for (const TruthBox& box : sample.boxes) {
      const cv::Rect2f pixels(box.share.x * 128, box.share.y * 64, box.share.width * 128, box.share.height * 64);
      ASSERT_GE(pixels.x, -1e-3f);
      ASSERT_LE(pixels.br().x, 128 + 1e-3f);
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 128; ++x) {
          if (pixels.contains({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f})) claimed.at<uchar>(y, x) = 255;
        }
      }
      checked += box.ignored ? 0 : 1;
    }
    // Half-white pixels at the rim may fall on either side.
    int wrong = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 128; ++x) {
        const uchar shown = sample.picture.at<cv::Vec3b>(y, x)[0];
        wrong += (shown > 200 && claimed.at<uchar>(y, x) == 0) || (shown < 50 && claimed.at<uchar>(y, x) != 0) ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << i;
  }
  EXPECT_GT(checked, 150);
}

TEST(Augment, WhatIsMostlyCutAwayIsIgnored) {
  const RandomStream random(2, "augment_test", "dice");
  const Sample source = white_box();
  AugmentConfig config = only_geometry();
  config.zoom_most = 4.0;
  config.mosaic = 0.0;
  config.aspect = 0.0;
  config.kept_share = 0.5;
  int ignored = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Dice dice(random, i);
    Dice same = dice;
    same.chance(config.mosaic);
    const double zoom = same.factor(config.zoom_least, config.zoom_most);
    const Sample sample = augmented([&](std::size_t) { return source; }, 1, 0, kSize, config, false, dice);
    for (const TruthBox& box : sample.boxes) {
      const double share = box.share.area() / (0.3 * 0.4 * zoom * zoom);
      if (std::abs(share - 0.5) > 0.06) {  // windows are whole pixels
        EXPECT_EQ(box.ignored, share < 0.5) << share;
      }
      ignored += box.ignored ? 1 : 0;
    }
  }
  EXPECT_GT(ignored, 5);
}

TEST(Augment, LatePicturesAreOftenWhole) {
  const RandomStream random(4, "augment_test", "dice");
  const Sample source = white_box();
  AugmentConfig config = only_geometry();
  config.flip = 0.0;
  cv::Mat expected(kSize, CV_8UC3);
  resize_picture(source.picture, expected);
  int whole = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Dice dice(random, i);
    const Sample sample = augmented([&](std::size_t) { return source; }, 1, 0, kSize, config, true, dice);
    if (cv::norm(sample.picture, expected, cv::NORM_INF) > 0.0) continue;
    ++whole;
    ASSERT_EQ(sample.boxes.size(), 1u);
    EXPECT_NEAR(sample.boxes[0].share.x, 0.35f, 1e-6f);
    EXPECT_NEAR(sample.boxes[0].share.width, 0.3f, 1e-6f);
  }
  EXPECT_NEAR(whole, 100, 30);
}

TEST(Augment, WhatIsPaintedOverIsLeftOutOfItsBox) {
  // A white rectangle with pieces painted over it: its box is the extent of the white that is left.
  const RandomStream random(5, "augment_test", "dice");
  const Sample source = white_box();
  AugmentConfig config = only_geometry();
  config.mosaic = config.flip = config.aspect = 0.0;
  config.zoom_least = config.zoom_most = 0.5;
  config.cut_out = 1.0;
  int trimmed = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Dice dice(random, i);
    const Sample sample = augmented([&](std::size_t) { return source; }, 1, 0, kSize, config, false, dice);
    ASSERT_EQ(sample.boxes.size(), 1u);
    if (sample.boxes[0].ignored) continue;
    cv::Mat white;
    cv::inRange(sample.picture, cv::Scalar::all(254), cv::Scalar::all(255), white);
    const cv::Rect seen = cv::boundingRect(white);
    const cv::Rect2f box(sample.boxes[0].share.x * 128, sample.boxes[0].share.y * 64, sample.boxes[0].share.width * 128,
                         sample.boxes[0].share.height * 64);
    // Two pieces side by side may hide a side that neither hides alone.
    trimmed += std::abs(box.width - 0.15f * 128) > 1.0f && std::abs(box.width - static_cast<float>(seen.width)) < 2.5f ? 1 : 0;
  }
  EXPECT_GT(trimmed, 12);
}

TEST(Augment, TheSameNumbersGiveTheSamePicture) {
  const RandomStream random(3, "augment_test", "dice");
  const Sample source = white_box();
  for (std::uint64_t i = 0; i < 10; ++i) {
    Dice one(random, i), two(random, i), other(random, i + 1);
    const auto make = [&](Dice& dice) { return augmented([&](std::size_t) { return source; }, 1, 0, kSize, AugmentConfig{}, false, dice); };
    const cv::Mat a = make(one).picture, b = make(two).picture, c = make(other).picture;
    EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(a, c, cv::NORM_INF), 0.0);
  }
}

TEST(EpochOrder, ShowsEveryPictureEquallyOften) {
  TrainConfig config;
  config.batch = 4;
  config.epoch_pictures = 30;
  const std::vector<std::size_t> order = epoch_order(10, config, 3);
  ASSERT_EQ(order.size(), 32u);
  std::vector<int> counts(10);
  for (std::size_t i = 0; i < 30; ++i) ++counts[order[i]];
  EXPECT_EQ(counts, std::vector<int>(10, 3));
  EXPECT_NE(order, epoch_order(10, config, 4));
  EXPECT_EQ(order, epoch_order(10, config, 3));
}

}  // namespace
}  // namespace waretwin::train
