#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/error.h"
#include "core/files.h"
#include "mapper/detect/boxes_detector.h"
#include "tests/support/expect_error.h"
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

TEST(BoxesDetector, TakesMasks) {
  const test::TemporaryFolder scratch;
  const auto file = scratch.path() / "boxes.json";
  // The first three columns of 4 x 5 pixels from row 1 on, as a list and as pycocotools' text of the same.
  const auto write_mask = [&](const std::string& mask) {
    write_file(file, R"({"frames": [{"stamp": 1, "detections": [{"class": "a", "box": [0, 1, 3, 3], "mask": )" + mask + "}]}]}");
  };
  RgbdFrame frame;
  frame.stamp = 1;
  frame.depth = cv::Mat::zeros(4, 5, CV_32FC1);
  cv::Mat expected = cv::Mat::zeros(4, 5, CV_8UC1);
  expected(cv::Rect(0, 1, 3, 3)) = 255;
  for (const char* counts : {"[1, 3, 1, 3, 1, 3, 8]", "\"1310007\""}) {
    write_mask(std::string(R"({"size": [4, 5], "counts": )") + counts + "}");
    const std::vector<Detection> found = BoxesDetector(file).detect(frame);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(cv::countNonZero(mask_picture(found[0].mask) != expected), 0) << counts;
  }
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"size": [4, 5], "counts": [1, 3]})", "together; expected width x height = 20"},
      {R"({"size": [4, 5], "counts": [1, -3, 22]})", "has a run of -3 pixels"},
      {R"({"size": [4, 5], "counts": "P"})", "counts ends within a number"},
      {R"({"size": [4, 5], "counts": "131\n"})", "counts has letter 4 that stands for no six bits"},
      {R"({"size": [4, 5], "counts": 3})", "expected COCO's run lengths"},
      {R"({"size": [4, 0], "counts": [0]})", "size is [4,0]; expected [height, width]"},
      {R"({"counts": [0]})", "frames[0].detections[0].mask has no \"size\""}};
  for (const auto& [mask, text] : wrong) {
    write_mask(mask);
    EXPECT_ERROR(read_boxes(file), text);
  }
  write_mask("null");
  ASSERT_EQ(BoxesDetector(file).detect(frame).size(), 1u);
  EXPECT_TRUE(BoxesDetector(file).detect(frame)[0].mask.empty());
  write_mask(R"({"size": [5, 4], "counts": [20]})");
  EXPECT_ERROR(BoxesDetector(file).detect(frame), "a mask of 4 x 5 pixels in a frame of 5 x 4");
}

// The files of the paper's authors.
class BoxFolder : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { write_file(folder_.path() / name, text); }
  std::filesystem::path path() const { return folder_.path(); }
  test::TemporaryFolder folder_;
};

TEST_F(BoxFolder, GivesEachFrameItsFile) {
  write("classes.txt", "station\nconveyor\n");
  write("1654000000.100000.txt", "1 150 40 100 20 0.75\n# a comment\nbox 10.5 20 30 40\n");
  write("1654000000.200000.txt", "");
  EXPECT_TRUE(is_boxes(path()));
  BoxesDetector detector(path());
  const std::vector<Detection> boxes = detector.detect(frame_at(1654000000'100000200));
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0].class_name, "conveyor");
  EXPECT_EQ(boxes[0].box, cv::Rect2f(150, 40, 50, 20)) << "cut off at the picture's edge";
  EXPECT_FLOAT_EQ(boxes[0].score, 0.75f);
  EXPECT_EQ(boxes[1].class_name, "box");
  EXPECT_EQ(boxes[1].box, cv::Rect2f(10.5f, 20, 30, 40));
  EXPECT_EQ(boxes[1].score, 1.0f);
  EXPECT_TRUE(detector.detect(frame_at(1654000000'200000000)).empty());
  EXPECT_TRUE(detector.detect(frame_at(1654000000'102000000)).empty());
}

TEST_F(BoxFolder, NamesAreTheConfigurations) {
  write("mine.names", "a\nb\n");
  write("other.list", "x\nconveyor\n");
  write("7.txt", "0 1 2 30 4\n1 1 2 3 40\n");
  DetectConfig config;
  config.rename = {"a=belt"};
  config.classes = {"belt"};
  const FrameBoxes picked = read_boxes(path(), config);
  ASSERT_EQ(picked.at(7'000'000'000).size(), 1u);
  EXPECT_EQ(picked.at(7'000'000'000)[0].class_name, "belt");
  config = {};
  config.names = (path() / "other.list").string();
  EXPECT_EQ(read_boxes(path(), config).at(7'000'000'000)[1].class_name, "conveyor");
  write("boxes.json", R"({"frames": [{"stamp": 1, "detections": [{"class": "a", "box": [1, 2, 3, 4]}]}]})");
  config = {};
  config.rename = {"0=x", "1=belt"};
  std::filesystem::remove(path() / "mine.names");
  EXPECT_EQ(read_boxes(path(), config).at(7'000'000'000)[1].class_name, "belt") << "numbers by themselves";
  config.rename = {"a=b"};
  EXPECT_EQ(read_boxes(path() / "boxes.json", config).at(1)[0].class_name, "b");
}

TEST_F(BoxFolder, SaysWhereAFileIsWrong) {
  EXPECT_ERROR(read_boxes(path()), "holds no boxes");
  EXPECT_FALSE(is_boxes(path()));
  const std::pair<const char*, const char*> rows[] = {
      {"0 1 2 30 4", "class 0 has no name"},  {"c 1 2 3", "7.5.txt:1: has 4 words; expected 'class x y w h'"},
      {"c 1 2 30 0", "30 x 0 pixels"},        {"c 0.5 0.5 0.2 0.2 1", "as shares of a picture are"},
      {"c 1 2 30 4 1.5", "the score is 1.5"}, {"c 1 2 x 4", "'x' is not a number"},
      {"c 1 2 nan 4", "'nan' is no pixel"}};
  for (const auto& [row, expected] : rows) {
    write("7.5.txt", std::string(row) + "\n");
    EXPECT_ERROR(read_boxes(path()), expected);
  }
  write("classes.txt", "a\n");
  write("7.5.txt", "1 1 2 30 4\n");
  EXPECT_ERROR(read_boxes(path()), "class 1 has no name; expected 0 to 0");
  write("7.5.txt", "");
  write("notes.txt", "");
  EXPECT_ERROR(read_boxes(path()), "notes.txt", "its name is no stamp");
  EXPECT_ERROR(read_boxes(path() / "none"), "no such file or folder");
}

TEST(BoxesDetector, SaysWhereAFileIsWrong) {
  const test::TemporaryFolder scratch;
  const auto file = scratch.path() / "boxes.json";
  const std::pair<const char*, const char*> cases[] = {
      {"", "boxes.json:1: is not JSON: it ends too early; expected an object with a list \"frames\""},
      {"{\"frames\":\n 01}", "boxes.json:2: is not JSON: it goes wrong at '1}'"},
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
