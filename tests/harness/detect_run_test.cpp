#include "harness/detect/detect_run.h"

#include <gtest/gtest.h>

#include "harness/detect/detection_drawing.h"
#include "harness/detect/set_scorer.h"
#include "tests/support/expect_error.h"

namespace waretwin {
namespace {

TEST(SetScorer, GivesWholePixelsBack) {
  const SetScorer scorer({"a", "b"}, {"b"}, {});
  // 32 x 32 belongs to the small and to the medium ones, in pictures of any width.
  for (int width = 601; width < 700; ++width) {
    LabelledImage image;
    image.boxes.push_back({1, {17.0 / width, 3.0 / 480, 32.0 / width, 32.0 / 480}, true, 700.0 / (480.0 * width)});
    const std::vector<TrueBox> truth = scorer.truth_of(image, {width, 480});
    ASSERT_EQ(truth.size(), 1u);
    EXPECT_EQ(truth[0].box, cv::Rect2d(17, 3, 32, 32)) << width;
    EXPECT_EQ(truth[0].area, 700.0) << width;
    EXPECT_EQ(truth[0].class_index, 1);
    EXPECT_TRUE(truth[0].ignored);
  }
}

TEST(SetScorer, MatchesClassesByName) {
  SetScorer scorer({"table", "chair"}, {"chair", "dog"}, {"chair", "dog"});
  const LabelledImage image{"", "", {{0, {0, 0, 0.5, 0.5}}, {1, {0.5, 0.5, 0.5, 0.5}}}};
  const std::vector<TrueBox> truth = scorer.truth_of(image, {100, 100});
  ASSERT_EQ(truth.size(), 1u);  // tables are not wanted
  EXPECT_TRUE(scorer.names("chair"));
  EXPECT_FALSE(scorer.names("dog"));
  std::vector<Detection> detections = {{"dog", {0, 0, 50, 50}, 0.95f}, {"chair", {50, 50, 50, 50}, 0.9f}};
  for (int i = 0; i < 200; ++i) detections.push_back({"chair", {0, 0, 50, 50}, 0.6f});
  scorer.add(truth, detections);
  const DetectionScore score = scorer.score({.confidence = 0.5, .match_iou = 0.5});
  EXPECT_EQ(score.at_threshold.all.right, 1);
  EXPECT_EQ(score.at_threshold.all.wrong, 99);  // no more than 100 of a class
  EXPECT_NEAR(score.coco.all.ap.value(), 1.0, 1e-12);
  EXPECT_EQ(score.labels, (std::vector<int>{0, 1}));
  EXPECT_ERROR(SetScorer({"table"}, {"dog", "cat"}, {}), "(dog, cat)", "(table)", "detect.rename");
}

TEST(DetectionDrawing, DetectionsAreSolidAndLabelsDashed) {
  const cv::Mat grey(200, 300, CV_8UC3, cv::Scalar::all(120));
  const cv::Mat drawn = draw_detections(grey, {{"dog", {20, 60, 100, 80}, 0.9f}}, {{0, {160, 60, 100, 80}}}, {"dog"});
  ASSERT_EQ(drawn.size(), grey.size());
  // Rows through the lower edges, where no names are: a solid line is of one colour, a dashed one changes to its rim and back.
  const auto at = [&](int row, int column) { return cv::Vec3d(drawn.at<cv::Vec3b>(row, column)); };
  const auto changes = [&](int row, int from, int to) {
    int count = 0;
    for (int u = from + 1; u < to; ++u) count += cv::norm(at(row, u) - at(row, u - 1)) > 60.0 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(changes(139, 25, 115), 0);
  EXPECT_GE(changes(140, 165, 255), 6);
  EXPECT_GT(cv::norm(at(139, 60) - cv::Vec3d::all(120)), 60.0);
  EXPECT_EQ(at(100, 70), cv::Vec3d::all(120));  // inside nothing is covered
  // Boxes at the edges and beyond are drawn as far as they are there.
  EXPECT_NO_THROW(draw_detections(grey, {{"dog", {0, 0, 300, 200}, 1.0f}}, {{0, {0, 0, 300, 200}}}, {"dog"}));
}

}  // namespace
}  // namespace waretwin
