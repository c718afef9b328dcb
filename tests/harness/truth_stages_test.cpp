#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "harness/truth/truth_associator.h"
#include "harness/truth/truth_detector.h"

namespace waretwin {
namespace {

TrueObject true_object(int id, const std::string& class_name) {
  TrueObject object;
  object.id = id;
  object.class_name = class_name;
  object.cuboid.centre = {0, 0, 2};
  object.cuboid.size = {1, 1, 1};
  return object;
}

class TruthBoxes : public testing::Test {
 protected:
  TruthBoxes() {
    instances_(cv::Rect(10, 20, 30, 5)) = 1;  // 150 pixels
    instances_(cv::Rect(60, 40, 2, 2)) = 2;   // 4 pixels
    instances_.at<std::uint16_t>(0, 0) = 9;   // no true object
    config_.min_pixels = 5;
    config_.min_depth_pixels = 0;
    config_.min_visible_share = 0.0;
  }
  std::vector<Detection> boxes() {
    return boxes_from_instances(instances_, depth_, {true_object(1, "conveyor"), true_object(2, "rack")}, intrinsics_, Pose::Identity(),
                                config_);
  }
  cv::Mat_<std::uint16_t> instances_ = cv::Mat_<std::uint16_t>::zeros(100, 100);
  cv::Mat_<float> depth_ = cv::Mat_<float>::zeros(100, 100);
  Intrinsics intrinsics_ = Intrinsics::checked(100, 100, 100, 100, 50, 50);
  TruthDetectorConfig config_;
};

TEST_F(TruthBoxes, AreTheSmallestAroundTheVisiblePixels) {
  const auto found = boxes();
  ASSERT_EQ(found.size(), 1u) << "the rack has too few pixels";
  EXPECT_EQ(found[0].class_name, "conveyor");
  EXPECT_EQ(found[0].box, cv::Rect2f(10, 20, 30, 5));
  EXPECT_EQ(found[0].score, 1.0f);
  config_.min_pixels = 4;
  EXPECT_EQ(boxes().size(), 2u);
}

TEST_F(TruthBoxes, HaveMasksWhereAskedFor) {
  EXPECT_TRUE(boxes()[0].mask.empty());
  config_.masks = true;
  EXPECT_EQ(cv::countNonZero((mask_picture(boxes()[0].mask) != 0) != (instances_ == 1)), 0);
}

TEST_F(TruthBoxes, NeedDepth) {
  config_.min_depth_pixels = 3;
  EXPECT_TRUE(boxes().empty());
  depth_(cv::Rect(12, 20, 3, 1)) = 1.5f;
  EXPECT_EQ(boxes().size(), 1u);
}

TEST_F(TruthBoxes, NeedAShareOfTheWholeObject) {
  // The cuboid from (-0.5, -0.5, 1.5) to (0.5, 0.5, 2.5) projects to 66.7 x 66.7 pixels: 150 of them are a share of 0.034.
  config_.min_visible_share = 0.03;
  EXPECT_EQ(boxes().size(), 1u);
  config_.min_visible_share = 0.04;
  EXPECT_TRUE(boxes().empty());
}

TEST(TrueIdentity, IsThatOfMostPixels) {
  cv::Mat_<std::uint16_t> instances = cv::Mat_<std::uint16_t>::zeros(2, 5);
  instances(0, 0) = instances(0, 1) = 1;
  instances(1, 0) = instances(1, 1) = instances(1, 2) = 2;
  const std::vector<TrueObject> objects = {true_object(1, "conveyor"), true_object(2, "conveyor"), true_object(3, "rack")};
  EXPECT_EQ(true_id_of({0, 1, 5}, instances, objects, "conveyor"), 1);
  EXPECT_EQ(true_id_of({0, 5, 6, 7}, instances, objects, "conveyor"), 2);
  EXPECT_EQ(true_id_of({0, 5}, instances, objects, "conveyor"), 1) << "equal counts: the smaller id";
  EXPECT_EQ(true_id_of({0, 5, 6, 7}, instances, objects, "rack"), 0) << "only its class";
  EXPECT_EQ(true_id_of({3, 4}, instances, objects, "conveyor"), 0) << "background";
  EXPECT_EQ(true_id_of({}, instances, objects, "conveyor"), 0);
}

}  // namespace
}  // namespace waretwin
