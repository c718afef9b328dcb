#include "harness/train/average_precision.h"

#include <gtest/gtest.h>

namespace waretwin::train {
namespace {

const cv::Rect2f kLeft(0.1f, 0.1f, 0.2f, 0.2f), kRight(0.6f, 0.6f, 0.2f, 0.2f), kNowhere(0.8f, 0.1f, 0.1f, 0.1f);

TEST(AveragePrecision, ByHand) {
  // Right, wrong, right of two objects: 0.5 * 1 + 0.5 * 2/3.
  const std::vector<std::vector<TruthBox>> truth = {{{0, kLeft, false}, {0, kRight, false}}};
  EXPECT_NEAR(average_precision({{{0, kLeft, 0.9f}, {0, kNowhere, 0.8f}, {0, kRight, 0.7f}}}, truth, 1, 0.5f), 0.5 + 0.5 * 2 / 3, 1e-9);
  EXPECT_NEAR(average_precision({{{0, kLeft, 0.9f}, {0, kRight, 0.7f}}}, truth, 1, 0.5f), 1.0, 1e-9);
  // A second box on one object is wrong.
  EXPECT_NEAR(average_precision({{{0, kLeft, 0.9f}, {0, kLeft, 0.8f}}}, truth, 1, 0.5f), 0.5, 1e-9);
  EXPECT_EQ(average_precision({{}}, truth, 1, 0.5f), 0.0);
}

TEST(AveragePrecision, ClassesAreAveragedAndIgnoredBoxesDoNotCount) {
  const std::vector<std::vector<TruthBox>> truth = {{{0, kLeft, false}, {1, kRight, false}, {0, kNowhere, true}}};
  EXPECT_NEAR(average_precision({{{0, kNowhere, 0.95f}, {0, kLeft, 0.9f}}}, truth, 3, 0.5f), 0.5, 1e-9);
  EXPECT_NEAR(average_precision({{{0, kLeft, 0.9f}, {1, kRight, 0.5f}}}, truth, 3, 0.5f), 1.0, 1e-9);
}

TEST(AveragePrecision, BalanceOfPrecisionAndRecallByHand) {
  // Right at 0.8 and 0.4, wrong at 0.2: two objects are best served by all that scores 0.4 or more.
  const std::vector<std::vector<TruthBox>> truth = {{{0, kLeft, false}, {0, kRight, false}}};
  EXPECT_NEAR(balanced_score({{{0, kLeft, 0.8f}, {0, kRight, 0.4f}, {0, kNowhere, 0.2f}}}, truth, 1, 0.5f), 0.4, 1e-6);
  // A wrong one before the second: F1 is 2/3 with the first alone, 4/5 with all three.
  EXPECT_NEAR(balanced_score({{{0, kLeft, 0.9f}, {0, kNowhere, 0.8f}, {0, kRight, 0.4f}}}, truth, 1, 0.5f), 0.4, 1e-6);
  EXPECT_EQ(balanced_score({{}}, truth, 1, 0.5f), 0.5);
  EXPECT_EQ(balanced_score({{{0, kNowhere, 0.9f}}}, truth, 1, 0.5f), 0.5);
}

TEST(AveragePrecision, SidesByHand) {
  // 0.01 of 1280 px at the left and right, nothing above and below.
  const cv::Rect2f moved(kLeft.x + 0.01f, kLeft.y, kLeft.width, kLeft.height);
  EXPECT_NEAR(median_side_error({{{0, moved, 0.9f}}}, {{{0, kLeft, false}}}, 1280, 720), 6.4, 1e-3);
}

}  // namespace
}  // namespace waretwin::train
