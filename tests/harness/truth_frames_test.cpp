#include "harness/truth/truth_frames.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "harness/truth/sensor_poses.h"
#include "mapper/detect/mask_runs.h"

namespace waretwin {
namespace {

Scene two_objects() {
  Scene scene;
  for (const int id : {1, 2}) {
    TrueObject object;
    object.id = id;
    object.class_name = id == 1 ? "conveyor" : "rack";
    scene.objects.push_back(object);
  }
  return scene;
}

// Of 6 x 5 pixels: object 1 covers columns 1 and 2 of rows 1 to 3, the upper of its rows hidden; object 2 lies beyond the picture.
struct Fixture {
  Fixture() {
    truth.stamp = 1'234'567'890'123;
    truth.sensor = "camera";
    truth.X_WC = make_upright_pose(1.0, 2.0, 3.0, 0.0);
    truth.instances = cv::Mat::zeros(5, 6, CV_16UC1);
    truth.instances(cv::Rect(1, 2, 2, 2)) = 1;
    ObjectView first;
    first.id = 1;
    first.visible_px = 4;
    first.amodal_px = 6;
    first.amodal_px_total = 6;
    first.visible_box = {1, 2, 2, 2};
    first.amodal_box = first.mask_box = {1, 1, 2, 3};
    first.amodal_mask = cv::Mat(3, 2, CV_8UC1, cv::Scalar(255));
    ObjectView second;
    second.id = 2;
    second.amodal_px_total = 9;
    second.amodal_box = {-4, 0, 3, 3};
    second.crosses_camera_plane = true;
    views = {first, second};
  }
  FrameTruth truth;
  std::vector<ObjectView> views;
};

TEST(TruthFrames, ALineHoldsWhatTheFrameShows) {
  const Fixture f;
  const std::string line = truth_frame_line(f.truth, f.views, two_objects(), true);
  EXPECT_EQ(line.find('\n'), line.size() - 1) << "one line";
  const nlohmann::json json = nlohmann::json::parse(line);
  EXPECT_EQ(json["stamp_ns"].get<std::int64_t>(), 1'234'567'890'123);
  EXPECT_EQ(json["sensor"], "camera");
  EXPECT_EQ(json["size"], nlohmann::json({6, 5}));
  EXPECT_EQ(json["X_WC"], nlohmann::json({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  ASSERT_EQ(json["objects"].size(), 2u);
  const nlohmann::json& first = json["objects"][0];
  EXPECT_EQ(first["id"], 1);
  EXPECT_EQ(first["class"], "conveyor");
  EXPECT_EQ(first["visible"], 0.6667);
  EXPECT_EQ(first["occluded"], 0.3333);
  EXPECT_EQ(first["truncated"], 0.0);
  EXPECT_EQ(first["visible_px"], 4);
  EXPECT_EQ(first["amodal_px"], 6);
  EXPECT_EQ(first["amodal_px_total"], 6);
  EXPECT_EQ(first["visible_box"], nlohmann::json({1, 2, 2, 2}));
  EXPECT_EQ(first["amodal_box"], nlohmann::json({1, 1, 2, 3}));
  EXPECT_EQ(first["amodal_mask"]["size"], nlohmann::json({5, 6})) << "height, then width, as COCO has it";
  EXPECT_EQ(first["amodal_mask"]["counts"], nlohmann::json({6, 3, 2, 3, 16}));
  const nlohmann::json& second = json["objects"][1];
  EXPECT_EQ(second["class"], "rack");
  EXPECT_EQ(second["truncated"], 1.0);
  EXPECT_TRUE(second["visible_box"].is_null());
  EXPECT_TRUE(second["amodal_mask"].is_null());
  EXPECT_EQ(second["amodal_box"], nlohmann::json({-4, 0, 3, 3}));
  EXPECT_EQ(second["crosses_camera_plane"], true);
  EXPECT_FALSE(nlohmann::json::parse(truth_frame_line(f.truth, f.views, two_objects(), false))["objects"][0].contains("amodal_mask"));
}

TEST(TruthFrames, RunLengthsGiveTheMaskBack) {
  cv::RNG random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const cv::Size size(3 + trial % 7, 2 + trial % 5);
    cv::Rect place(random.uniform(0, size.width), random.uniform(0, size.height), 0, 0);
    place.width = random.uniform(1, size.width - place.x + 1);
    place.height = random.uniform(1, size.height - place.y + 1);
    cv::Mat mask(place.size(), CV_8UC1);
    for (int v = 0; v < mask.rows; ++v) {
      for (int u = 0; u < mask.cols; ++u) mask.at<std::uint8_t>(v, u) = random.uniform(0, 2) != 0 ? 255 : 0;
    }
    cv::Mat whole = cv::Mat::zeros(size, CV_8UC1), back = cv::Mat::zeros(size, CV_8UC1);
    mask.copyTo(whole(place));
    const std::vector<int> runs = run_lengths(mask, place, size);
    int pixel = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      EXPECT_TRUE(i == 0 || runs[i] > 0);
      for (int k = 0; k < runs[i]; ++k, ++pixel) {
        back.at<std::uint8_t>(pixel % size.height, pixel / size.height) = i % 2 == 1 ? 255 : 0;
      }
    }
    EXPECT_EQ(pixel, size.area());
    EXPECT_EQ(cv::norm(whole, back, cv::NORM_L1), 0.0);
  }
}

TEST(TruthFrames, ThePictureShowsInstancesAndBoxes) {
  FrameTruth truth;
  truth.instances = cv::Mat::zeros(200, 300, CV_16UC1);
  truth.instances(cv::Rect(200, 80, 50, 40)) = 1;
  ObjectView view;
  view.id = 1;
  view.visible_px = view.amodal_px = 2000;
  view.amodal_px_total = 4000;
  view.visible_box = view.mask_box = {200, 80, 50, 40};
  view.amodal_mask = cv::Mat(40, 50, CV_8UC1, cv::Scalar(255));
  view.amodal_box = {200, 80, 131, 40};
  const cv::Mat colour(200, 300, CV_8UC3, cv::Scalar::all(100));
  const cv::Mat image = draw_truth(colour, truth, {view}, two_objects());
  ASSERT_EQ(image.size(), colour.size());
  // The picture is two thirds as large in the middle of its margin: (u, v) goes to (2/3 (u + 75), 2/3 (v + 50)).
  EXPECT_EQ(image.at<cv::Vec3b>(60, 70), cv::Vec3b::all(45)) << "darkened beside the object";
  EXPECT_EQ(image.at<cv::Vec3b>(3, 3), image.at<cv::Vec3b>(195, 295)) << "the margin";
  EXPECT_NE(image.at<cv::Vec3b>(3, 3), cv::Vec3b::all(45));
  EXPECT_NE(image.at<cv::Vec3b>(108, 213), cv::Vec3b::all(45)) << "tinted";
  // Along the right side of the amodal box, beyond the picture, some pixels are drawn and some are not.
  int drawn = 0;
  for (int v = 88; v < 111; ++v) drawn += image.at<cv::Vec3b>(v, 270) != image.at<cv::Vec3b>(3, 3) ? 1 : 0;
  EXPECT_GT(drawn, 8);
  EXPECT_LT(drawn, 23);
}

TEST(SensorPoses, AreThoseOfTheDriveThroughTheMounts) {
  Scenario scenario;
  scenario.name = "poses";
  scenario.robot.drive.model = "exact";
  scenario.robot.route.resize(2);
  scenario.robot.route[1].x_m = 1.0;
  scenario.sensors = SensorsConfig::of_the_paper();
  Scene scene;
  Mesh floor;
  floor.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}};
  floor.normals.assign(3, Eigen::Vector3f::UnitZ());
  floor.triangles = {0, 1, 2};
  scene.materials.emplace_back();
  scene.meshes.push_back(floor);
  scene.instances.emplace_back();
  SimulatedStream stream(scenario, std::make_shared<const Scene>(scene), SimulationConfig());
  SensorPoses poses(stream, scenario.sensors);
  std::map<std::string, std::size_t> counts;
  while (const auto event = stream.next()) {
    poses.add(*event);
    std::visit([&](const auto& e) { ++counts[e.sensor]; }, *event);
    if (!std::holds_alternative<RgbdFrame>(*event)) continue;
    const StampedPose& camera = poses.poses().at("cameras/camera.tum").back();
    EXPECT_TRUE(camera.X_WB.isApprox(stream.last_frame_truth().X_WC, 1e-12));
    EXPECT_EQ(camera.stamp, stream.last_frame_truth().stamp);
  }
  const auto& all = poses.poses();
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all.at("cameras/camera.tum").size(), counts["camera"]);
  EXPECT_EQ(all.at("cameras/camera.depth.tum").size(), counts["camera"]);
  EXPECT_EQ(all.at("lasers/laser.tum").size(), counts["laser"]);
  EXPECT_EQ(all.at("odometry.tum").size(), counts["odometry"]);
  EXPECT_GT(counts["camera"], 10u);
  for (const StampedPose& point : all.at("lasers/laser.tum")) {
    const Pose X_BL = scenario.sensors.lasers.at("laser").mount.X_BL();
    EXPECT_TRUE(point.X_WB.isApprox(stream.true_X_WB(point.stamp) * X_BL, 1e-12));
  }
  for (const StampedPose& point : all.at("odometry.tum")) EXPECT_TRUE(point.X_WB.isApprox(stream.true_X_WB(point.stamp), 1e-12));
  // The depth lens is 32 mm beside the colour lens.
  const Pose& X_WC = all.at("cameras/camera.tum")[3].X_WB;
  EXPECT_NEAR((all.at("cameras/camera.depth.tum")[3].X_WB.translation() - X_WC.translation()).norm(), 0.032, 1e-9);
}

}  // namespace
}  // namespace waretwin
