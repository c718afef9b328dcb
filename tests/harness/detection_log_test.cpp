// Detections of a run beside the truth, frame by frame.
#include "harness/run/detection_log.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace waretwin {
namespace {

using Json = nlohmann::json;

Scene a_conveyor_and_a_rack() {
  Scene scene;
  for (const int id : {1, 2}) {
    TrueObject object;
    object.id = id;
    object.class_name = id == 1 ? "conveyor" : "rack";
    scene.objects.push_back(object);
  }
  return scene;
}

ObjectView view_of(int id, const cv::Rect& box, double visible) {
  ObjectView view;
  view.id = id;
  view.visible_px = box.area();
  view.amodal_px = box.area();
  view.amodal_px_total = static_cast<std::int64_t>(box.area() / visible);
  view.visible_box = box;
  return view;
}

Detection found(const std::string& name, const cv::Rect2f& box, float score) { return {name, box, score}; }

RgbdFrame frame_at(Stamp stamp) {
  RgbdFrame frame;
  frame.stamp = stamp;
  frame.sensor = "camera";
  return frame;
}

TEST(DetectionLog, CountsWhatIsToBeFoundAndNothingElse) {
  DetectionLog log(a_conveyor_and_a_rack(), {});
  // Found; a rack taken for a conveyor; a conveyor of which little is visible need not be found.
  log.add(frame_at(1), {found("conveyor", {12, 20, 98, 50}, 0.9f), found("conveyor", {300, 300, 60, 60}, 0.8f)},
          {view_of(1, {10, 20, 100, 50}, 1.0), view_of(2, {300, 300, 60, 60}, 0.9)});
  // Of a class that the hall has none of: nobody says that it is not there.
  log.add(frame_at(2), {found("person", {10, 20, 100, 50}, 0.9f)}, {view_of(1, {10, 20, 100, 50}, 0.2)});
  log.add(frame_at(3), {found("conveyor", {0, 0, 40, 40}, 0.6f)}, {view_of(1, {10, 20, 100, 50}, 0.2)});
  const auto score = log.score();
  ASSERT_TRUE(score);
  EXPECT_EQ(score->images, 3);
  EXPECT_EQ(score->labels, (std::vector<int>{1, 1}));
  EXPECT_EQ(score->ignored_labels, 2);
  EXPECT_EQ(score->other_detections, 1);
  EXPECT_EQ(score->classes, (std::vector<std::string>{"conveyor", "rack"}));
  const ThresholdFigures& conveyor = score->at_threshold.classes[0];
  EXPECT_EQ(conveyor.right, 1);
  EXPECT_EQ(conveyor.wrong, 2) << "the rack, and a place where nothing is";
  EXPECT_EQ(conveyor.missed, 0);
  EXPECT_EQ(score->at_threshold.classes[1].missed, 1);
  const auto taken = std::find_if(score->at_threshold.confusions.begin(), score->at_threshold.confusions.end(),
                                  [](const Confusion& c) { return c.truth == 1 && c.detected == 0; });
  ASSERT_NE(taken, score->at_threshold.confusions.end());
  EXPECT_EQ(taken->count, 1);

  std::istringstream lines(log.lines());
  std::vector<Json> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(Json::parse(line));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["stamp_ns"], 1);
  EXPECT_EQ(rows[0]["detections"].size(), 2u);
  EXPECT_EQ(rows[0]["detections"][0]["box"], (Json{12.0, 20.0, 98.0, 50.0}));
  EXPECT_EQ(rows[0]["truth"][1]["class"], "rack");
  EXPECT_EQ(rows[0]["truth"][1]["ignored"], false);
  EXPECT_EQ(rows[1]["detections"][0]["class"], "person");
  EXPECT_EQ(rows[1]["truth"][0]["ignored"], true);
}

TEST(DetectionLog, SaysNothingWithoutFramesOrObjects) {
  EXPECT_FALSE(DetectionLog(a_conveyor_and_a_rack(), {}).score());
  DetectionLog log(Scene(), {});
  log.add(frame_at(1), {found("conveyor", {0, 0, 10, 10}, 0.9f)}, {});
  EXPECT_FALSE(log.score());
}

}  // namespace
}  // namespace waretwin
