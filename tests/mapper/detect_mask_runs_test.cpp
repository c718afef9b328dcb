// Masks as COCO's run lengths, held against a plain reader of the format.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "mapper/detect/mask_runs.h"
#include "tests/support/coco_masks.h"
#include "tests/support/expect_error.h"

namespace waretwin {
namespace {

cv::Mat random_mask(std::uint64_t seed, int width, int height) {
  const RandomStream random(seed, "mask", "test");
  cv::Mat mask(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool set = random.uniform(static_cast<std::uint64_t>(y / 3 * width + x / 3)) > 0.5;  // pieces of 3 x 3
      mask.at<std::uint8_t>(y, x) = set ? 255 : 0;
    }
  }
  return mask;
}

TEST(MaskRuns, ReadBack) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const cv::Mat mask = random_mask(seed, 37, 23);
    const cv::Size size(90, 70);
    const cv::Rect place(13, 40, 37, 23);
    cv::Mat placed = cv::Mat::zeros(size, CV_8UC1);
    mask.copyTo(placed(place));
    const MaskRuns runs{size, run_lengths(mask, place, size)};
    EXPECT_NO_THROW(expect_whole(runs));
    EXPECT_TRUE(test::same(test::from_runs(runs.runs, size), placed));
    EXPECT_TRUE(test::same(mask_picture(runs), placed));
    EXPECT_EQ(test::read_runs(compressed_runs(runs.runs)), runs.runs);
    EXPECT_EQ(read_compressed_runs(compressed_runs(runs.runs)), runs.runs);
  }
  // Numbers of every length and sign.
  const std::vector<int> runs = {0, 15, 16, 31, 32, 1000, 1023, 1, 1024, 1000000, 3, 2};
  EXPECT_EQ(test::read_runs(compressed_runs(runs)), runs);
  EXPECT_EQ(read_compressed_runs(compressed_runs(runs)), runs);
}

TEST(MaskRuns, FillTheWholePicture) {
  cv::Mat whole(3, 5, CV_8UC1, 255);
  const MaskRuns full{whole.size(), run_lengths(whole, {0, 0, 5, 3}, whole.size())};
  EXPECT_EQ(full.runs, (std::vector<int>{0, 15}));
  EXPECT_TRUE(test::same(mask_picture(full), whole));
  for (const std::vector<int>& runs : std::vector<std::vector<int>>{{0, 14}, {0, 15, 1}, {16, -1}, {}}) {
    EXPECT_THROW(expect_whole({whole.size(), runs}), Error);
  }
}

TEST(MaskRuns, WhatIsNoSuchTextIsRefused) {
  const std::string open(1, static_cast<char>(48 + 0x20));  // a number that goes on
  for (const std::string& text : {open, std::string("\x7f"), std::string("1 2"), std::string(9, open[0]) + "1"}) {
    EXPECT_THROW(read_compressed_runs(text), Error) << text;
  }
  EXPECT_ERROR(read_compressed_runs("1 2"), "has letter 2, ' ', that stands for no six bits");
  for (const char* unprintable : {"13\n", "13\xc3", "13\x7f"})
    EXPECT_ERROR(read_compressed_runs(unprintable), "has letter 3 that stands for");
}

}  // namespace
}  // namespace waretwin
