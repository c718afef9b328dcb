#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::agiprobot;
using test::TemporaryFolder;
using Json = nlohmann::json;

Json run(const std::string& options, const std::filesystem::path& out) {
  const auto result = test::waretwin("run " + agiprobot() + " --quiet --out '" + out.string() + "' " + options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  if (result.exit_code != 0) return Json();
  return Json::parse(read_file(out / "score.json"));
}

// The figures that profile `paper` has to reach: near the paper's Table 6, with laser poses and sensor depth.
TEST(ClosedLoop, MapsTheAgiProbotHallAsThePaperDoes) {
  const TemporaryFolder folder;
  const Json score = run("--profile paper --detector truth", folder.path());
  ASSERT_TRUE(score.is_object());
  const Json& summary = score["summary"];
  EXPECT_EQ(summary["truth"], 4);
  EXPECT_EQ(summary["matched"], 4);
  EXPECT_GE(summary["mean_iou3d"].get<double>(), 0.70);
  EXPECT_LE(summary["mean_e_trans_m"].get<double>(), 0.06);
  EXPECT_LE(summary["mean_e_rot_deg"].get<double>(), 3.0);
  for (const Json& object : score["objects"]) EXPECT_GE(object["visible_fraction"].get<double>(), 0.6) << object.dump();
  EXPECT_LE(score["peak_rss_mb"].get<double>(), 1536.0);
  for (const char* name : {"table6.md",
                           "cuboids.json",
                           "truth.json",
                           "map.glb",
                           "map.ply",
                           "map.waretwin",
                           "occupancy.pgm",
                           "occupancy.yaml",
                           "cloud.ply",
                           "trajectory.tum",
                           "trajectory_truth.tum",
                           "timing.csv",
                           "topdown.png",
                           "mesh.png",
                           "config.yaml",
                           "report.html",
                           "truth_frames.jsonl",
                           "truth_poses/odometry.tum",
                           "truth_poses/cameras/camera.tum",
                           "truth_poses/cameras/camera.depth.tum",
                           "truth_poses/lasers/laser.tum"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
    EXPECT_GT(std::filesystem::file_size(folder.path() / name), 0u) << name;
  }
  for (const char* name : {"objects", "frames"}) EXPECT_FALSE(std::filesystem::is_empty(folder.path() / name)) << name;

  // Whoever compares the files gets the same score.
  const auto again = test::waretwin("score '" + folder.path().string() + "' --truth '" + folder.path().string() + "' --out '" +
                                    (folder.path() / "again").string() + "'");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const Json file_score = Json::parse(read_file(folder.path() / "again/score.json"));
  EXPECT_NEAR(file_score["summary"]["mean_iou3d"].get<double>(), summary["mean_iou3d"].get<double>(), 1e-6);
  EXPECT_EQ(test::waretwin("inspect '" + (folder.path() / "map.waretwin").string() + "'").exit_code, 0);
}

TEST(ClosedLoop, GivesTheSameDigestAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const std::string options = "--profile paper --detector truth --frames 91 --threads ";
  const Json one = run(options + "1", folder.path() / "1");
  const Json two = run(options + "2", folder.path() / "2");
  const Json four = run(options + "4", folder.path() / "4");
  ASSERT_TRUE(one.is_object() && two.is_object() && four.is_object());
  EXPECT_GE(one["frames"]["mapped"].get<int>(), 6);
  EXPECT_FALSE(Json::parse(read_file(folder.path() / "1/cuboids.json"))["objects"].empty())
      << "the drive must be long enough to map an object";
  EXPECT_EQ(one["digest"], two["digest"]);
  EXPECT_EQ(one["digest"], four["digest"]);
  EXPECT_EQ(read_file(folder.path() / "1/cuboids.json"), read_file(folder.path() / "4/cuboids.json"));
  EXPECT_EQ(read_file(folder.path() / "1/map.ply"), read_file(folder.path() / "4/map.ply"));
  const std::string truth = read_file(folder.path() / "1/truth_frames.jsonl");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), one["frames"]["mapped"].get<int>()) << "a line a mapped frame";
  EXPECT_EQ(truth, read_file(folder.path() / "2/truth_frames.jsonl"));
  EXPECT_EQ(truth, read_file(folder.path() / "4/truth_frames.jsonl"));
}

// As it comes, at a lower rate: no truth in the loop, boxes from the shipped model.
TEST(ClosedLoop, FindsTheConveyorsWithItsOwnDetector) {
  const TemporaryFolder folder;
  const Json score =
      run("--set sensors.cameras.camera.rate_hz=1 --set extras.surface=false --set extras.depth=false", folder.path() / "run");
  ASSERT_TRUE(score.is_object());
  EXPECT_EQ(score["stages"]["detector"], "yolo");
  EXPECT_EQ(score["summary"]["matched"], 4);
  EXPECT_EQ(score["summary"]["mapped"], 4) << "and nothing else";
  EXPECT_GE(score["summary"]["mean_iou3d"].get<double>(), 0.6);
  const Json& detection = score["detection"];
  EXPECT_GE(detection["recall"].get<double>(), 0.6);
  EXPECT_GE(detection["precision"].get<double>(), 0.8);
  EXPECT_EQ(detection["other_detections"], 0);
  const std::string lines = read_file(folder.path() / "run/detections.jsonl");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), score["frames"]["mapped"].get<int>()) << "a line a mapped frame";
  EXPECT_NE(read_file(folder.path() / "run/report.html").find("Detections in the mapped frames"), std::string::npos);

  const std::string part = "--set sensors.cameras.camera.rate_hz=1 --frames 6 --threads ";
  const Json one = run(part + "1", folder.path() / "1"), two = run(part + "2", folder.path() / "2");
  ASSERT_TRUE(one.is_object() && two.is_object());
  EXPECT_EQ(one["digest"], two["digest"]);
  EXPECT_EQ(read_file(folder.path() / "1/detections.jsonl"), read_file(folder.path() / "2/detections.jsonl"));
}

TEST(ClosedLoop, SaysWhatWasNotMeasured) {
  const TemporaryFolder folder;
  const std::string quick = "--detector none --frames 6 --set sensors.cameras.camera.rate_hz=2 --set simulation.colour=false ";
  const Json laser = run(quick + "--set extras.surface=false --set extras.depth=false --set extras.visible_share=false", folder.path());
  EXPECT_EQ(laser["trajectory"]["unlocalised_share"], 0.0);
  EXPECT_TRUE(laser["surface"].is_null() && laser["depth"].is_null());
  EXPECT_EQ(laser["summary"]["truth"], 4);  // all are taken for seen
  const Json odometry = run(quick + "--poses odometry", folder.path());
  EXPECT_EQ(odometry["trajectory"]["unlocalised_share"], 1.0);
  EXPECT_EQ(odometry["summary"]["truth"], 0);  // after six frames
}

TEST(ClosedLoop, ChangesWithTheSeedOnly) {
  const TemporaryFolder folder;
  const std::string options = "--profile paper --detector truth --frames 16 ";
  const Json first = run(options, folder.path() / "first");
  const Json again = run(options, folder.path() / "again");
  const Json other = run(options + "--seed 99", folder.path() / "other");
  ASSERT_TRUE(first.is_object() && again.is_object() && other.is_object());
  EXPECT_EQ(first["digest"], again["digest"]);
  EXPECT_NE(first["digest"], other["digest"]);
  EXPECT_EQ(other["seed"], 99);
  EXPECT_NE(read_file(folder.path() / "other/config.yaml").find("seed: 99"), std::string::npos);
}

TEST(ClosedLoop, IsRepeatedFromItsOwnConfiguration) {
  const TemporaryFolder folder;
  const Json first = run("--profile paper --depth truth --seed 7 --frames 31 --set mapper.integrate.voxel_m=0.03", folder.path() / "first");
  const std::string config = "--config '" + (folder.path() / "first/config.yaml").string() + "' ";
  const Json again = run(config, folder.path() / "again");
  const Json changed = run(config + "--set mapper.integrate.voxel_m=0.05", folder.path() / "changed");
  ASSERT_TRUE(first.is_object() && again.is_object() && changed.is_object());
  EXPECT_EQ(first["digest"], again["digest"]);
  EXPECT_EQ(first["stages"], again["stages"]);
  EXPECT_EQ(read_file(folder.path() / "first/config.yaml"), read_file(folder.path() / "again/config.yaml"));
  EXPECT_NE(first["digest"], changed["digest"]);
}

TEST(ClosedLoop, TakesAModelForDetector) {
  WARETWIN_NEED_DATA("yolo_fastest");
  const TemporaryFolder folder;
  const Json score =
      run("--profile paper --detector '" + test::shared_data("yolo_fastest").string() + "' --frames 121 --set mapper.detect.confidence=0.1",
          folder.path());
  ASSERT_TRUE(score.is_object());
  EXPECT_EQ(score["stages"]["detector"], "yolo");
  EXPECT_GT(score["timing_ms"]["detect"]["median"].get<double>(), 0.0);
  EXPECT_EQ(score["summary"]["matched"], 0) << "the model knows no conveyors";
}

TEST(ClosedLoop, PutsTheTruthInPlaceOfStages) {
  const TemporaryFolder folder;
  const Json score = run("--profile paper --detector truth --poses truth --depth truth --association truth --frames 31", folder.path());
  ASSERT_TRUE(score.is_object());
  EXPECT_NEAR(score["trajectory"]["ate_max_m"].get<double>(), 0.0, 1e-9);
  EXPECT_EQ(score["stages"]["depth"], "truth");
  EXPECT_EQ(score["stages"]["association"], "truth");
}

// The small network sees the chair in two frames of sixty.
TEST(ClosedLoop, FindsAChairInAKitchen) {
  WARETWIN_NEED_DATA("rgbd_7scenes");
  WARETWIN_NEED_DATA("yolo_fastest");
  const TemporaryFolder folder;
  const auto result = test::waretwin("map '" + test::shared_data("rgbd_7scenes").string() + "' --quiet --out '" + folder.path().string() +
                                     "' --detector '" + test::shared_data("yolo_fastest").string() +
                                     "' --set mapper.detect.confidence=0.3 --set mapper.evidence.min_observations=2");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("60 of 60 frames mapped"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" chair at "), std::string::npos) << result.out;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "upright.json")) << "this world's y axis points down";
}

TEST(ClosedLoop, MapsARecordingOfARealCamera) {
  WARETWIN_NEED_DATA("rgbd_sun3d");
  WARETWIN_NEED_DATA("yolo_fastest");
  const TemporaryFolder folder;
  const auto result = test::waretwin("map '" + test::shared_data("rgbd_sun3d").string() + "' --quiet --out '" + folder.path().string() +
                                     "' --detector '" + test::shared_data("yolo_fastest").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("5 of 5 frames mapped"), std::string::npos) << result.out;
  EXPECT_GT(std::filesystem::file_size(folder.path() / "map.ply"), 1u << 20);
  EXPECT_TRUE(Json::parse(read_file(folder.path() / "cuboids.json"))["objects"].is_array());
}

}  // namespace
}  // namespace waretwin
