#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::agiprobot;
using test::in_quotes;
using test::TemporaryFolder;
using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string digest_in(const std::string& text) {
  const auto at = text.find("digest ");
  return at == std::string::npos ? "none" : text.substr(at + 7, 16);
}

void record(const std::string& options, const fs::path& out) {
  const auto result = test::waretwin("record " + agiprobot() + " --quiet --out " + in_quotes(out) + " " + options);
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

// A recording into `out` that gets a signal as soon as its partial folder is there.
test::ProgramResult stopped_by(const std::string& signal, const fs::path& out) {
  const TemporaryFolder folder;
  const std::string err = in_quotes(folder.path() / "err");
  const std::string script = "'" WARETWIN_PROGRAM "' record " + agiprobot() + " --quiet --out " + in_quotes(out) + " 2>" + err +
                             " & pid=$!; for i in $(seq 600); do ls " + in_quotes(out.string() + ".partial-") +
                             "*/rgb.txt >/dev/null 2>&1 && break; sleep 0.1; done; kill -" + signal + " $pid; wait $pid";
  const int status = std::system(script.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, "", read_file(folder.path() / "err")};
}

TEST(Record, MappedGivesTheDigestOfARun) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive", boxes = folder.path() / "boxes.json";
  // One frame a second, so that the drive is long enough to see a conveyor.
  const std::string small =
      "--seed 5 --set sensors.cameras.camera.rate_hz=1 --set sensors.cameras.camera.width=640 --set "
      "sensors.cameras.camera.height=360 ";
  const std::string options = "--frames 8 " + small;
  record(options, drive);
  for (const char* name :
       {"rgb/000007.png", "depth/000007.png", "depth_native/000007.png", "rgb.txt", "depth.txt", "depth_native.txt", "laser.txt",
        "odometry.txt", "recording.yaml", "truth.json", "trajectory_truth.tum", "truth_boxes.json", "config.yaml"}) {
    EXPECT_TRUE(fs::exists(drive / name)) << name;
  }
  EXPECT_FALSE(fs::exists(drive / "groundtruth.txt")) << "a mapper must not learn the true poses";

  Json frames = Json::array();
  for (int i = 0; i < 8; ++i) {
    frames.push_back(
        {{"stamp", i * 1'000'000'000LL}, {"detections", {{{"class", "conveyor"}, {"box", {200, 50, 250, 200}}, {"score", 0.9}}}}});
  }
  write_file(boxes, Json{{"frames", frames}}.dump());
  for (const std::string mapping : {"--profile paper --detector none", "--profile best --detector none --rate 1"}) {
    SCOPED_TRACE(mapping);
    const auto run = test::waretwin("run " + agiprobot() + " --quiet --out " + in_quotes(folder.path() / "run") + " " + options + mapping);
    const auto map = test::waretwin("map " + in_quotes(drive) + " --quiet --out " + in_quotes(folder.path() / "map") + " " + mapping);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(map.exit_code, 0) << map.err;
    EXPECT_EQ(digest_in(run.out), digest_in(map.out));
    EXPECT_EQ(digest_in(map.out).find_first_not_of("0123456789abcdef"), std::string::npos) << map.out;
  }
  {
    // Unless told otherwise, boxes come from the shipped model.
    const auto run = test::waretwin("run " + agiprobot() + " --quiet --out " + in_quotes(folder.path() / "yolo_run") + " " + options);
    const auto map =
        test::waretwin("map " + in_quotes(drive) + " --quiet --out " + in_quotes(folder.path() / "yolo_map") + " --detector yolo");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(map.exit_code, 0) << map.err;
    EXPECT_EQ(digest_in(run.out), digest_in(map.out));
    const Json score = Json::parse(read_file(folder.path() / "yolo_run/score.json"));
    EXPECT_EQ(score["stages"]["detector"], "yolo");
    EXPECT_GT(score["detection"]["tp"].get<int>(), 0) << "the drive's eight pictures show conveyors";
  }
  // With boxes and with fewer frames than there are.
  const std::string mapping = "--profile paper --frames 6 --detector " + in_quotes(boxes);
  const auto run = test::waretwin("run " + agiprobot() + " --quiet --out " + in_quotes(folder.path() / "run") + " " + small + mapping);
  const auto map = test::waretwin("map " + in_quotes(drive) + " --quiet --out " + in_quotes(folder.path() / "map") + " " + mapping);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(map.exit_code, 0) << map.err;
  EXPECT_EQ(digest_in(run.out), digest_in(map.out));
  EXPECT_EQ(read_file(folder.path() / "run/trajectory.tum"), read_file(folder.path() / "map/trajectory.tum"));
  EXPECT_FALSE(Json::parse(read_file(folder.path() / "map/cuboids.json"))["objects"].empty()) << "a box must have become an object";

  // The true boxes stand beside the recording: with them it maps as a run with the true detector does.
  const std::string short_run = " --profile paper --detector truth " + options;
  const auto true_run = test::waretwin("run " + agiprobot() + " --quiet --out " + in_quotes(folder.path() / "true_run") + short_run);
  const auto true_map = test::waretwin("map " + in_quotes(drive) + " --quiet --out " + in_quotes(folder.path() / "true_map") +
                                       " --profile paper --detector " + in_quotes(drive / "truth_boxes.json"));
  ASSERT_EQ(true_run.exit_code, 0) << true_run.err;
  ASSERT_EQ(true_map.exit_code, 0) << true_map.err;
  EXPECT_EQ(digest_in(true_run.out), digest_in(true_map.out));

  // The truth beside it scores both.
  const auto score = test::waretwin("score " + in_quotes(folder.path() / "map") + " --truth " + in_quotes(drive / "truth.json"));
  EXPECT_EQ(score.exit_code, 0) << score.err;
  const auto ate =
      test::waretwin("score " + in_quotes(folder.path() / "map/trajectory.tum") + " --truth " + in_quotes(drive / "trajectory_truth.tum"));
  ASSERT_EQ(ate.exit_code, 0) << ate.err;
  const auto of_run = Json::parse(read_file(folder.path() / "run/score.json"))["trajectory"]["ate_rmse_m"].get<double>();
  EXPECT_NEAR(Json::parse(ate.out)["trajectory"]["ate_unaligned_rmse_m"].get<double>(), of_run, 1e-6);
}

std::string mapped_digest(const fs::path& drive, const std::string& options) {
  const TemporaryFolder out;
  const auto map = test::waretwin("map " + in_quotes(drive) + " --quiet --out " + in_quotes(out.path() / "map") + " " + options);
  EXPECT_EQ(map.exit_code, 0) << map.err;
  return digest_in(map.out);
}

// One drive in every layout: one map, and of the layouts that carry the true poses the same map by them.
TEST(Record, GivesTheSameMapInEveryFormat) {
  const TemporaryFolder folder;
  std::vector<std::string> formats = {"tum", "scenenn", "7scenes"};
#ifdef WARETWIN_ROSBAG
  formats.push_back("rosbag");
#endif
  std::set<std::string> by_laser, by_poses;
  for (const std::string& format : formats) {
    const fs::path drive = folder.path() / format;
    record(
        "--frames 3 --set sensors.cameras.camera.rate_hz=1 --set sensors.cameras.camera.width=640 --set sensors.cameras.camera.height=360 "
        "--format " +
            format,
        drive);
    by_laser.insert(mapped_digest(drive, "--profile best"));
    if (format == "scenenn" || format == "7scenes") by_poses.insert(mapped_digest(drive, "--profile best --poses recorded"));
    // An earlier recording of any format is replaced by one of any other.
    if (format == "scenenn") record("--frames 1 --format tum", drive);
  }
  EXPECT_EQ(by_laser.size(), 1u);
  EXPECT_EQ(by_poses.size(), 1u);
  EXPECT_NE(*by_laser.begin(), "none");
  EXPECT_NE(*by_laser.begin(), *by_poses.begin());
  EXPECT_FALSE(fs::exists(folder.path() / "scenenn/image"));
}

TEST(Record, SceneNnFoldersHoldTheTruthAsItsAnnotation) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "011";
  record("--frames 1 --format scenenn", drive);
  EXPECT_NE(read_file(drive / "011.xml").find("nyu_class=\"conveyor\" obbox=\""), std::string::npos);
  EXPECT_EQ(read_file(drive / "trajectory.log").substr(0, 6), "0 0 1\n");
  // As truth it is worth as much as truth.json.
  const auto score = test::waretwin("score " + in_quotes(drive / "truth.json") + " --truth " + in_quotes(drive / "011.xml") + " --out " +
                                    in_quotes(folder.path() / "score"));
  ASSERT_EQ(score.exit_code, 0) << score.err;
  EXPECT_NEAR(Json::parse(read_file(folder.path() / "score/score.json"))["summary"]["mean_iou3d"].get<double>(), 1.0, 1e-9);
}

#ifdef WARETWIN_ROSBAG
// ROS's own reader finds what was recorded; the same drive is the same file.
TEST(Record, ABagOpensInRosbagInfo) {
  const TemporaryFolder folder;
  const std::string options = "--frames 2 --format rosbag --set bag.compression=lz4 --threads ";
  record(options + "1", folder.path() / "1");
  record(options + "4", folder.path() / "4");
  const fs::path bag = folder.path() / "1/recording.bag";
  EXPECT_EQ(read_file(bag), read_file(folder.path() / "4/recording.bag"));
  const fs::path script = folder.path() / "list.py", list = folder.path() / "list.txt";
  write_file(script,
             "import sys\ntry:\n  import rosbag\nexcept ImportError:\n  sys.exit(77)\n"
             "for topic, what in sorted(rosbag.Bag(sys.argv[1]).get_type_and_topic_info().topics.items()):\n"
             "  print(topic, what.msg_type, what.message_count)\n");
  const int status = std::system(("/usr/bin/python3 " + in_quotes(script) + " " + in_quotes(bag) + " > " + in_quotes(list)).c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "python3-rosbag is not installed";
  ASSERT_EQ(status, 0);
  const std::string text = read_file(list);
  for (const char* line : {"/camera/rgb/image_raw sensor_msgs/Image 2\n", "/camera/rgb/camera_info sensor_msgs/CameraInfo 2\n",
                           "/camera/depth_registered/image_raw sensor_msgs/Image 2\n", "/camera/depth/image_raw sensor_msgs/Image 2\n",
                           "/tf_static tf2_msgs/TFMessage 1\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " is not in\n" << text;
  }
  const auto rows = [](const fs::path& file) {
    const std::string lines = read_file(file);
    return std::count(lines.begin(), lines.end(), '\n') - 1;  // the first is a comment
  };
  record("--frames 2", folder.path() / "tum");
  EXPECT_NE(text.find("/scan sensor_msgs/LaserScan " + std::to_string(rows(folder.path() / "tum/laser.txt"))), std::string::npos) << text;
  EXPECT_NE(text.find("/odom nav_msgs/Odometry " + std::to_string(rows(folder.path() / "tum/odometry.txt"))), std::string::npos) << text;

  // As a bag from elsewhere, without what stands beside it: tf, camera_info and headers say the same to their last digits but a few.
  fs::create_directories(folder.path() / "alone");
  fs::rename(bag, folder.path() / "alone/drive.bag");
  const auto seen = test::waretwin("inspect " + in_quotes(folder.path() / "alone/drive.bag"));
  EXPECT_NE(seen.out.find("1280 x 720 pixels, fx 640"), std::string::npos) << seen.out << seen.err;
  EXPECT_NE(seen.out.find("at (0.275, 0.2, 0.3) m on the vehicle, yaw 43.9 deg"), std::string::npos) << seen.out;
  EXPECT_NE(seen.out.find("depth camera's own images: 640 x 576"), std::string::npos) << seen.out;
}
#endif

TEST(Record, IsTheSameAtAnyNumberOfThreadsAndMapsWithoutItsTruth) {
  const TemporaryFolder folder;
  record("--frames 3 --threads 1", folder.path() / "1");
  record("--frames 3 --threads 4", folder.path() / "4");
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "1")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const fs::path name = fs::relative(entry.path(), folder.path() / "1");
    EXPECT_EQ(read_file(entry.path()), read_file(folder.path() / "4" / name)) << name;
  }
  EXPECT_EQ(files, 3 * 3 + 10);
  const std::string map = " --quiet --profile paper --detector none --out " + in_quotes(folder.path() / "map");
  const auto with = test::waretwin("map " + in_quotes(folder.path() / "1") + map);
  for (const char* name : {"truth.json", "truth_boxes.json", "trajectory_truth.tum", "config.yaml"}) fs::remove(folder.path() / "1" / name);
  const auto without = test::waretwin("map " + in_quotes(folder.path() / "1") + map);
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_EQ(digest_in(with.out), digest_in(without.out));
}

// The vehicle stands in its own sensors' view, on wheels, with a bracket that is off: what the mapper leaves out is in the recording, too.
TEST(Record, MapsAsTheRunWithTheVehicleInView) {
  const TemporaryFolder folder;
  const std::string vehicle =
      "--frames 6 --set robot.model=vehicle.glb --set sensors.cameras.camera.rate_hz=2 --set sensors.cameras.camera.width=640 --set "
      "sensors.cameras.camera.height=360 --set "
      "sensors.cameras.camera.mount.bracket.angle_sigma_deg=0.3";
  record(vehicle, folder.path() / "drive");
  const std::string map = " --quiet --detector none --out ";
  const auto mapped = test::waretwin("map " + in_quotes(folder.path() / "drive") + map + in_quotes(folder.path() / "map"));
  const auto run = test::waretwin("run " + agiprobot() + map + in_quotes(folder.path() / "run") + " " + vehicle);
  const auto without = test::waretwin(
      "run " + agiprobot() + map + in_quotes(folder.path() / "bare") +
      " --frames 6 --set sensors.cameras.camera.rate_hz=2 --set sensors.cameras.camera.width=640 --set sensors.cameras.camera.height=360");
  EXPECT_EQ(digest_in(mapped.out), digest_in(run.out)) << mapped.err << run.err;
  EXPECT_NE(digest_in(run.out), digest_in(without.out));
  EXPECT_NE(read_file(folder.path() / "drive/recording.yaml").find("own_body: [-0.4"), std::string::npos);
}

TEST(Record, ReplacesOnlyWhatItMade) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive";
  record("--frames 2", drive);
  record("--frames 1", drive);
  EXPECT_FALSE(fs::exists(drive / "rgb/000001.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1) << "nothing is left beside it";
  const std::string again = "record " + agiprobot() + " --quiet --frames 1 --out ";
  EXPECT_ONE_LINE(test::waretwin("map " + in_quotes(drive) + " --out " + in_quotes(drive)), "recording.yaml");
  EXPECT_TRUE(fs::exists(drive / "truth.json")) << "a map does not clean up in a recording";
  write_file(drive / "notes.txt", "mine");
  EXPECT_ONE_LINE(test::waretwin(again + in_quotes(drive)), "notes.txt");
  fs::remove(drive / "notes.txt");
  fs::remove(drive / "trajectory_truth.tum");
  EXPECT_ONE_LINE(test::waretwin(again + in_quotes(drive)), "trajectory_truth.tum");
  EXPECT_TRUE(fs::exists(drive / "rgb/000000.png"));
  write_file(folder.path() / "file", "mine");
  EXPECT_ONE_LINE(test::waretwin(again + in_quotes(folder.path() / "file")), "is a file");
  EXPECT_ONE_LINE(test::waretwin(again + "/proc/nowhere/drive"), "/proc/nowhere");
}

TEST(Record, LeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive";
  record("--frames 1", drive);
  const std::string before = read_file(drive / "rgb.txt");
  // A limit on the size of files stands for a full disk.
  const auto full =
      test::waretwin("record " + agiprobot() + " --quiet --frames 2 --out " + in_quotes(drive), "ulimit -f 64; trap '' XFSZ;");
  EXPECT_ONE_LINE(full, "cannot write");
  // Stopped politely once it writes, it tidies up.
  const auto stopped = stopped_by("TERM", drive);
  EXPECT_EQ(stopped.exit_code, 2);
  EXPECT_NE(stopped.err.find("stopped by signal"), std::string::npos) << stopped.err;
  EXPECT_EQ(read_file(drive / "rgb.txt"), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1) << "a partial folder is left";
  // Killed outright, it leaves the half-written folder under another name than the result's.
  const auto killed = stopped_by("KILL", folder.path() / "other");
  EXPECT_EQ(killed.exit_code, 137);
  EXPECT_FALSE(fs::exists(folder.path() / "other"));
}

TEST(Record, RefusesWhatItCannotHold) {
  const TemporaryFolder copy;
  fs::copy(test::repository() / "scenes/agiprobot", copy.path() / "hall", fs::copy_options::recursive);
  const fs::path scenario = copy.path() / "hall/scenario.yaml";
  std::string text = read_file(scenario);
  text.replace(text.find("  lasers:\n"), 0,
               "    rear:\n      preset: azure_kinect_gaussian\n      mount: {z_m: 1.4, yaw_deg: 180, pitch_deg: 45}\n");
  write_file(scenario, text);
  const std::string two = "record " + in_quotes(scenario) + " --quiet --frames 1 --out " + in_quotes(copy.path() / "drive");
  EXPECT_ONE_LINE(test::waretwin(two), "sensors.cameras: camera, rear");
  EXPECT_ONE_LINE(test::waretwin(two), "--camera NAME");
  EXPECT_ONE_LINE(test::waretwin(two + " --camera front"), "--camera front");
  EXPECT_FALSE(fs::exists(copy.path() / "drive")) << "bad input leaves nothing behind";
  EXPECT_EQ(test::waretwin(two + " --camera rear").exit_code, 0);
  EXPECT_NE(read_file(copy.path() / "drive/recording.yaml").find("name: rear"), std::string::npos);
  EXPECT_ONE_LINE(test::waretwin("record nowhere.yaml --out o"), "nowhere.yaml");
  EXPECT_ONE_LINE(test::waretwin("record " + agiprobot()), "--out");
  EXPECT_ONE_LINE(test::waretwin("record " + agiprobot() + " --out o --format rosbag2"), "rosbag2");
  EXPECT_ONE_LINE(test::waretwin("record " + agiprobot() + " --out o --set mapper.rate_hz=1"), "mapper");
}

// The keys that a drive was recorded with come back from its pictures.
TEST(InspectNoise, FindsTheNoiseThatADriveWasRecordedWith) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive", json = folder.path() / "noise.json";
  record(
      "--frames 30 --set sensors.cameras.camera.preset=azure_kinect_gaussian --set sensors.cameras.camera.noise.sigma_base_m=0.001 "
      "--set sensors.cameras.camera.noise.sigma_per_m2=0.002 --set sensors.cameras.camera.noise.dropout_share=0.03 "
      "--set sensors.cameras.camera.rate_hz=0.7 --set simulation.colour=false",
      drive);
  const auto result = test::waretwin("inspect " + in_quotes(drive) + " --noise --quiet --json " + in_quotes(json));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* words :
       {"sigma_z = base + growth * z^2", "the gaussian law fits better", "sigma_per_m2:", "dropout_share:", "30 of 30 frames"}) {
    EXPECT_NE(result.out.find(words), std::string::npos) << words << " is not in\n" << result.out;
  }
  const Json noise = Json::parse(read_file(json));
  EXPECT_EQ(noise["view"], "registered");
  EXPECT_NEAR(noise["gaussian"]["sigma_base_m"]["value"].get<double>(), 0.001, 0.15 * 0.001) << result.out;
  EXPECT_NEAR(noise["gaussian"]["sigma_per_m2"]["value"].get<double>(), 0.002, 0.15 * 0.002) << result.out;
  EXPECT_NEAR(noise["planar_missing_share"].get<double>(), 0.03, 0.003);
  EXPECT_LT(std::abs(noise["correlation"].get<double>()), 0.05);
}

TEST(InspectNoise, MeasuresTheDepthCamerasOwnImages) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive", json = folder.path() / "noise.json";
  record("--frames 20 --set sensors.cameras.camera.rate_hz=0.5 --set simulation.colour=false", drive);
  const std::string command = "inspect " + in_quotes(drive) + " --noise --quiet --json " + in_quotes(json);
  const auto own = test::waretwin(command + " --frames 10");
  ASSERT_EQ(own.exit_code, 0) << own.err;
  const Json native = Json::parse(read_file(json));
  EXPECT_EQ(native["view"], "native");
  EXPECT_EQ(native["used_frames"], 10);
  EXPECT_EQ(native["width"], 640);
  EXPECT_EQ(native["better_law"], "time_of_flight");
  fs::remove(drive / "depth_native.txt");
  const auto warped = test::waretwin(command);
  ASSERT_EQ(warped.exit_code, 0) << warped.err;
  EXPECT_NE(warped.out.find("depth_native.txt"), std::string::npos) << "interpolated depth is said to be so\n" << warped.out;
  const Json registered = Json::parse(read_file(json));
  EXPECT_EQ(registered["view"], "registered");
  EXPECT_LT(registered["time_of_flight"]["noise_m"]["value"].get<double>(), native["time_of_flight"]["noise_m"]["value"].get<double>());
}

// Two scans in a square room, 0.1 m apart.
TEST(LaserLog, IsInspectedAndMappedToATrajectory) {
  const TemporaryFolder folder;
  const auto scan = [](double x, double stamp) {
    std::string line = "FLASER 181";
    for (int i = 0; i <= 180; ++i) {
      const double angle = (i - 90.0) * 3.14159265358979 / 180.0, c = std::cos(angle), s = std::abs(std::sin(angle));
      line += " " + std::to_string(std::min(c > 1e-9 ? (4.0 - x) / c : 99.0, s > 1e-9 ? 3.0 / s : 99.0));
    }
    return line + " 0 0 0 0 0 0 " + std::to_string(stamp) + " host 0\n";
  };
  const fs::path log = folder.path() / "drive.log", out = folder.path() / "out";
  write_file(log, "PARAM robot_frontlaser_offset 0.2 0 h 0\nODOM 0 0 0 0 0 0 1 h 1\n" + scan(0.0, 1.0) + "ODOM 0.12 0 0 0 0 0 1.2 h 1.2\n" +
                      scan(0.1, 1.2));
  const auto inspected = test::waretwin("inspect " + in_quotes(log));
  EXPECT_EQ(inspected.exit_code, 0) << inspected.err;
  EXPECT_NE(inspected.out.find("181 beams over 180 deg"), std::string::npos) << inspected.out;
  EXPECT_NE(inspected.out.find("2 scans, 2 odometry readings"), std::string::npos) << inspected.out;
  for (const std::string profile : {"best", "paper"}) {
    const auto mapped = test::waretwin("map " + in_quotes(log) + " --quiet --profile " + profile + " --out " + in_quotes(out));
    ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
    EXPECT_NE(mapped.out.find("2 poses of the laser"), std::string::npos) << mapped.out;
    std::istringstream rows(read_file(out / "trajectory.tum"));
    double stamp = 0, x = 0, y = 0;
    std::string rest;
    for (const double expected : {0.2, 0.3}) {
      rows >> stamp >> x >> y;
      std::getline(rows, rest);
      EXPECT_NEAR(x, expected, 0.002) << "the laser stands 0.2 m in front of the vehicle's centre";
      EXPECT_NEAR(y, 0.0, 0.002);
    }
    EXPECT_TRUE(fs::exists(out / "report.html"));
    EXPECT_TRUE(fs::exists(out / "config.yaml"));
    EXPECT_FALSE(fs::exists(out / "map.glb"));
    EXPECT_EQ(fs::exists(out / "trajectory_covariance.csv"), profile == "best");
  }
  const auto seen = test::waretwin("inspect " + in_quotes(out));
  EXPECT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_NE(seen.out.find("map of a laser log: 2 poses of the laser in 0.2 s"), std::string::npos) << seen.out;
  write_file(log, "FLASER 2 1\n");
  EXPECT_ONE_LINE(test::waretwin("map " + in_quotes(log) + " --out " + in_quotes(out)), "drive.log:1:");
}

TEST(InspectRecording, SaysThatDepthHasAnotherSizeThanThePictures) {
  const TemporaryFolder folder;
  write_file(folder.path() / "1.ppm", "P6 8 6 255\n" + std::string(3 * 8 * 6, '\1'));
  write_file(folder.path() / "1.pgm", "P5 4 3 65535\n" + std::string(2 * 4 * 3, '\1'));
  write_file(folder.path() / "rgb.txt", "1 1.ppm\n");
  write_file(folder.path() / "depth.txt", "1 1.pgm\n");
  const auto seen = test::waretwin("inspect " + in_quotes(folder.path()));
  EXPECT_EQ(seen.exit_code, 2) << seen.out;
  EXPECT_NE(seen.err.find("1.pgm: has 4 x 3 pixels; expected 8 x 6"), std::string::npos) << seen.err;
}

TEST(InspectNoise, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_ONE_LINE(test::waretwin("inspect nowhere --noise"), "nowhere");
  EXPECT_ONE_LINE(test::waretwin("inspect " + agiprobot() + " --noise"), "expected a recording's folder");
  EXPECT_ONE_LINE(test::waretwin("inspect " + in_quotes(folder.path()) + " --noise"), "is no recording");
  EXPECT_ONE_LINE(test::waretwin("inspect " + in_quotes(folder.path()) + " --frames 3"), "--noise");
  EXPECT_ONE_LINE(test::waretwin("inspect " + in_quotes(folder.path()) + " --noise --frames 0"), "--frames");
  EXPECT_ONE_LINE(test::waretwin("inspect " + in_quotes(folder.path()) + " --noise --reflectivity 7"), "--reflectivity");
  write_file(folder.path() / "laser.txt", "0 -1 0.5 0 0.05 30 3 1 0 2\n");
  EXPECT_ONE_LINE(test::waretwin("inspect " + in_quotes(folder.path()) + " --noise"), "no depth images");
  EXPECT_ONE_LINE(test::waretwin("inspect " + in_quotes(folder.path()) + " --noise --set noise.frame=3"), "noise.frames");
  const auto keys = test::waretwin("inspect " + in_quotes(folder.path()) + " --noise --keys");
  EXPECT_EQ(keys.exit_code, 0) << keys.err;
  EXPECT_NE(keys.out.find("max_structure"), std::string::npos);
}

}  // namespace
}  // namespace waretwin
