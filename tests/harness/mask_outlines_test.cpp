// Masks as polygons, held against a plain filling of them.
#include "harness/truth/mask_outlines.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "core/random.h"
#include "tests/support/coco_masks.h"

namespace waretwin {
namespace {

// Blobs with holes, islands in holes, pixels that touch at corners only.
cv::Mat random_mask(std::uint64_t seed, int width, int height) {
  const RandomStream random(seed, "mask", "test");
  cv::Mat noise(height, width, CV_32FC1), smooth;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) noise.at<float>(y, x) = static_cast<float>(random.uniform(static_cast<std::uint64_t>(y * width + x)));
  }
  if (seed % 2 == 1) {
    cv::GaussianBlur(noise, smooth, {0, 0}, 2.0);
  } else {
    smooth = noise;
  }
  return smooth > 0.5;
}

TEST(MaskOutlines, OutlinesFillToTheMask) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const cv::Mat mask = random_mask(seed, 41, 29);
    const cv::Size size(60, 50);
    cv::Mat placed = cv::Mat::zeros(size, CV_8UC1);
    mask.copyTo(placed(cv::Rect(7, 11, 41, 29)));
    EXPECT_TRUE(test::same(test::filled(outlines(mask, {7, 11}, 0.0), size), placed));
  }
}

TEST(MaskOutlines, OutlinesOfASquareAndARing) {
  cv::Mat mask = cv::Mat::zeros(5, 6, CV_8UC1);
  mask(cv::Rect(1, 1, 4, 3)).setTo(255);
  EXPECT_EQ(outlines(mask, {10, 20}, 0.0), (std::vector<std::vector<double>>{{11, 21, 15, 21, 15, 24, 11, 24}}));
  mask.at<std::uint8_t>(2, 2) = 0;
  const auto ring = outlines(mask, {0, 0}, 0.0);
  ASSERT_EQ(ring.size(), 1u) << "one piece, its hole joined by a seam";
  EXPECT_TRUE(test::same(test::filled(ring, mask.size()), mask));
}

TEST(MaskOutlines, ToleranceLeavesOutStairs) {
  cv::Mat mask = cv::Mat::zeros(200, 200, CV_8UC1);
  cv::circle(mask, {100, 100}, 80, 255, -1);
  const auto exact = outlines(mask, {0, 0}, 0.0), coarse = outlines(mask, {0, 0}, 1.0);
  ASSERT_EQ(coarse.size(), 1u);
  EXPECT_LT(coarse[0].size(), exact[0].size() / 4);
  const int off = cv::countNonZero(test::filled(coarse, mask.size()) != mask);
  EXPECT_LT(off, cv::countNonZero(mask) / 50);
}

}  // namespace
}  // namespace waretwin
