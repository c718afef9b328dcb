#include "harness/train/anchors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace waretwin::train {
namespace {

// `count` shapes within 5 % of each centre.
std::vector<BoxShape> scattered(const std::vector<BoxShape>& centres, int count) {
  const RandomStream random(5, "anchors_test", "shapes");
  std::vector<BoxShape> shapes;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    for (int i = 0; i < count; ++i) {
      const std::uint64_t index = k * count + i;
      shapes.push_back(
          {centres[k].width * (0.95 + 0.1 * random.uniform(index, 0)), centres[k].height * (0.95 + 0.1 * random.uniform(index, 1))});
    }
  }
  return shapes;
}

TEST(Anchors, OverlapOfShapesByHand) {
  EXPECT_DOUBLE_EQ(shape_iou({2, 3}, {2, 3}), 1.0);
  EXPECT_DOUBLE_EQ(shape_iou({2, 2}, {1, 1}), 0.25);
  EXPECT_DOUBLE_EQ(shape_iou({4, 1}, {1, 4}), 1.0 / 7.0);
}

TEST(Anchors, ClustersAreFoundWhateverTheirSizes) {
  const std::vector<BoxShape> centres = {{1, 1}, {2, 6}, {7, 3}, {12, 12}, {30, 10}};
  const std::vector<BoxShape> shapes = scattered(centres, 40);
  const std::vector<BoxShape> anchors = find_anchors(shapes, 5);
  ASSERT_EQ(anchors.size(), 5u);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    EXPECT_NEAR(anchors[i].width, centres[i].width, 0.03 * centres[i].width);
    EXPECT_NEAR(anchors[i].height, centres[i].height, 0.03 * centres[i].height);
  }
  EXPECT_GT(mean_best_iou(shapes, anchors), 0.93);
}

TEST(Anchors, MoreOfThemFitBetter) {
  std::vector<BoxShape> shapes;
  const RandomStream random(6, "anchors_test", "shapes");
  for (std::uint64_t i = 0; i < 300; ++i) shapes.push_back({1 + 20 * random.uniform(i, 0), 1 + 15 * random.uniform(i, 1)});
  double before = 0.0;
  for (const int count : {1, 2, 4, 8}) {
    const std::vector<BoxShape> anchors = find_anchors(shapes, count);
    const double iou = mean_best_iou(shapes, anchors);
    EXPECT_GT(iou, before + 0.02) << count;
    before = iou;
  }
}

TEST(Anchors, OneShapeGivesItselfAndVersionsOfIt) {
  const std::vector<BoxShape> anchors = find_anchors({{4, 2}, {4, 2}}, 3);
  ASSERT_EQ(anchors.size(), 3u);
  EXPECT_NEAR(anchors[0].width, 4 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(anchors[1].width, 4, 1e-9);
  EXPECT_NEAR(anchors[2].width, 4 * std::sqrt(2.0), 1e-9);
  for (const BoxShape& anchor : anchors) EXPECT_NEAR(anchor.width, 2 * anchor.height, 1e-9);
}

}  // namespace
}  // namespace waretwin::train
