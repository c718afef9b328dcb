#include "harness/train/epoch_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "core/parallel.h"
#include "tests/support/test_data.h"
#include "tests/train/rectangles_set.h"

namespace waretwin::train {
namespace {

TEST(EpochLoader, AnyNumberOfThreadsMakesTheSameBatches) {
  const test::TemporaryFolder folder;
  test::write_rectangles(folder.path(), 20, 1);
  const LabelledSet set = read_labelled_set(folder.path(), "train");
  TrainConfig config;
  config.epoch_pictures = 20;
  const auto epoch = [&](int threads) {
    set_thread_count(threads);
    PictureCache cache(set, {240, 144}, 10 * 3 * 240 * 144);  // half of the pictures find room
    EpochLoader loader(cache, config, 1, {{160, 96}, false});
    std::vector<Sample> shown;
    while (const auto batch = loader.next()) {
      EXPECT_EQ(batch->size(), 8u);
      shown.insert(shown.end(), batch->begin(), batch->end());
    }
    return shown;
  };
  const std::vector<Sample> one = epoch(1), many = epoch(3);
  set_thread_count(0);
  ASSERT_EQ(one.size(), 24u);
  ASSERT_EQ(many.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(cv::norm(one[i].picture, many[i].picture, cv::NORM_INF), 0.0) << i;
    ASSERT_EQ(one[i].boxes.size(), many[i].boxes.size());
    for (std::size_t k = 0; k < one[i].boxes.size(); ++k) EXPECT_EQ(one[i].boxes[k].share, many[i].boxes[k].share);
  }
}

TEST(EpochLoader, AnEpochShowsEveryPictureOnceAndFillsTheLastBatch) {
  TrainConfig config;
  config.epoch_pictures = 1;
  std::vector<std::size_t> order = epoch_order(21, config, 4);
  ASSERT_EQ(order.size(), 24u);
  EXPECT_NE(order, epoch_order(21, config, 5));
  std::sort(order.begin(), order.begin() + 21);
  for (std::size_t i = 0; i < 21; ++i) EXPECT_EQ(order[i], i);
  config.epoch_pictures = 100;
  order = epoch_order(21, config, 4);
  ASSERT_EQ(order.size(), 104u);
  for (std::size_t i = 0; i < 21; ++i) EXPECT_GE(std::count(order.begin(), order.end(), i), 4);
}

}  // namespace
}  // namespace waretwin::train
