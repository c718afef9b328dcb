#include <gtest/gtest.h>

#include "mapper/associate/box_views.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin {
namespace {

// One pixel a centimetre at 1 m, looking along x from the origin.
BoxView view(const cv::Rect2f& box) { return {test::camera_pose(0, 0, 0, 0, 0), Intrinsics::checked(200, 100, 100, 100, 100, 50), box}; }

TEST(BoxViews, ShowsBallsWhereTheyProject) {
  BoxViews views(32);
  views.add(view({0, 0, 10, 10}));
  // Left of the axis and above it: smaller u, smaller v.
  const ShownBoxes shown = views.shown(std::vector<Eigen::Vector3f>{{1.0f, 0.2f, 0.1f}, {2.0f, -0.4f, 0.0f}}, 0.02);
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_NEAR(shown[0].x, 100.5 - 20 - 2, 1e-3);
  EXPECT_NEAR(shown[0].y, 50.5 - 10 - 2, 1e-3);
  EXPECT_NEAR(shown[0].x + shown[0].width, 100.5 + 20 + 1, 1e-3);
  EXPECT_NEAR(shown[0].y + shown[0].height, 50.5 + 1, 1e-3);
}

TEST(BoxViews, CutsAtThePicturesEdgesAndLeavesOutWhatIsBehind) {
  BoxViews views(32);
  views.add(view({0, 0, 10, 10}));
  const ShownBoxes cut = views.shown(std::vector<Eigen::Vector3f>{{1.0f, 0.99f, 0.0f}, {1.0f, 3.0f, 0.0f}}, 0.01);
  EXPECT_NEAR(cut[0].x, 0.0, 1e-4);
  EXPECT_NEAR(cut[0].x + cut[0].width, 2.5, 1e-3);
  EXPECT_TRUE(views.shown(std::vector<Eigen::Vector3f>{{-1.0f, 0.0f, 0.0f}}, 0.01)[0].empty());
  EXPECT_TRUE(views.shown(std::vector<Eigen::Vector3f>{{1.0f, 5.0f, 0.0f}}, 0.01)[0].empty());
}

TEST(BoxViews, MatchIsTheMeanOverlap) {
  BoxViews views(32);
  EXPECT_EQ(views.match({}), 0.0);
  views.add(view({0, 0, 10, 10}));
  views.add(view({0, 0, 10, 10}));
  EXPECT_NEAR(views.match({cv::Rect2f(0, 0, 10, 10), cv::Rect2f(0, 0, 5, 10)}), 0.75, 1e-6);
  EXPECT_NEAR(views.match({cv::Rect2f(), cv::Rect2f(5, 0, 10, 10)}), 0.5 / 3.0, 1e-6);
  const ShownBoxes both = united({cv::Rect2f(0, 0, 5, 10), cv::Rect2f()}, {cv::Rect2f(5, 0, 5, 10), cv::Rect2f(0, 0, 10, 10)});
  EXPECT_NEAR(views.match(both), 1.0, 1e-6);
}

TEST(BoxViews, KeepsViewsSpreadOverAllOfThem) {
  // Of a long drive the boxes move to the right: what is kept must still know its beginning and its end.
  BoxViews views(8);
  for (int i = 0; i < 100; ++i) views.add(view({static_cast<float>(i), 0, 1, 1}));
  const std::size_t kept = views.shown(std::vector<Eigen::Vector3f>{{1, 0, 0}}, 0.01).size();
  EXPECT_GE(kept, 8u);
  EXPECT_LT(kept, 16u);
  const auto overlap = [&](float from, float to) {
    return views.match(ShownBoxes(kept, cv::Rect2f(from, 0, to - from, 1))) * static_cast<double>(kept) * (to - from);
  };
  // Each kept box lies inside or outside of an interval as a whole.
  EXPECT_NEAR(overlap(0, 25) + overlap(25, 50), overlap(50, 75) + overlap(75, 100), 1.5);
}

TEST(BoxViews, HalvesOfOneObjectBothHaveTheirSay) {
  BoxViews views(8), others(8);
  for (int i = 0; i < 320; ++i) {
    views.add(view({0, 0, 10, 10}));
    others.add(view({50, 50, 10, 10}));
  }
  views.add(others);
  const std::size_t kept = views.shown(std::vector<Eigen::Vector3f>{{1, 0, 0}}, 0.01).size();
  EXPECT_NEAR(views.match(ShownBoxes(kept, cv::Rect2f(50, 50, 10, 10))), 0.5, 0.1);
}

}  // namespace
}  // namespace waretwin
