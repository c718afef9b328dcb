#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "mapper/detect/boxes_detector.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

RgbdFrame frame_at(Stamp stamp) {
  RgbdFrame frame;
  frame.stamp = stamp;
  frame.colour = cv::Mat(100, 200, CV_8UC3, cv::Scalar(0, 0, 0));
  return frame;
}

TEST(BoxesDetector, GivesEachFrameItsOwn) {
  const test::TemporaryFolder scratch;
  const auto file = scratch.path() / "boxes.json";
  write_file(file, R"({"frames": [
    {"stamp": 1000000000, "detections": [{"class": "conveyor", "box": [150, 40, 100, 20], "score": 0.75}, {"class": "table", "box": [300, 0, 10, 10]}]},
    {"stamp": 2000000000, "detections": []},
    {"stamp": 3000000000, "detections": [{"class": "chair", "box": [1, 2, 3, 4]}]}]})");
  BoxesDetector detector(file);
  const std::vector<Detection> first = detector.detect(frame_at(1'000'000'000));
  ASSERT_EQ(first.size(), 1u);  // the table lies outside of the picture
  EXPECT_EQ(first[0].class_name, "conveyor");
  EXPECT_EQ(first[0].box, cv::Rect2f(150, 40, 50, 20));
  EXPECT_FLOAT_EQ(first[0].score, 0.75f);
  EXPECT_TRUE(detector.detect(frame_at(2'000'000'000)).empty());
  EXPECT_EQ(detector.detect(frame_at(3'000'900'000)).size(), 1u);
  EXPECT_EQ(detector.detect(frame_at(2'999'100'000)).size(), 1u);
  EXPECT_TRUE(detector.detect(frame_at(3'001'100'000)).empty());
  EXPECT_TRUE(detector.detect(frame_at(0)).empty());
  EXPECT_TRUE(NoDetector().detect(frame_at(0)).empty());
}

TEST(BoxesDetector, SaysWhereAFileIsWrong) {
  const test::TemporaryFolder scratch;
  const auto file = scratch.path() / "boxes.json";
  const std::pair<const char*, const char*> cases[] = {
      {"", "not JSON"},
      {"[]", "frames"},
      {R"({"frames": 3})", "expected a list"},
      {R"({"frames": [{"detections": []}]})", "frames[0] has no \"stamp\""},
      {R"({"frames": [{"stamp": 1.5, "detections": []}]})", "whole nanoseconds"},
      {R"({"frames": [{"stamp": 1, "detections": []}, {"stamp": 1, "detections": []}]})", "twice"},
      {R"({"frames": [{"stamp": 1, "detections": [{"class": "a", "box": [1, 2, 3]}]}]})", "frames[0].detections[0]: box"},
      {R"({"frames": [{"stamp": 1, "detections": [{"class": "a", "box": [1, 2, 3, -1]}]}]})", "above 0"},
      {R"({"frames": [{"stamp": 1, "detections": [{"class": "a", "box": [1, 2, 3, 4], "score": 7}]}]})", "score"},
      {R"({"frames": [{"stamp": 1, "detections": [{"class": 5, "box": [1, 2, 3, 4]}]}]})", "class is 5"}};
  for (const auto& [text, expected] : cases) {
    write_file(file, text);
    try {
      BoxesDetector detector(file);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& problem) {
      EXPECT_NE(std::string(problem.what()).find(expected), std::string::npos) << problem.what();
      EXPECT_NE(std::string(problem.what()).find("boxes.json"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace waretwin
