// `calibrate`, and what --extrinsics changes.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::agiprobot;
using test::in_quotes;
using test::repository;
using test::TemporaryFolder;
using Json = nlohmann::json;
namespace fs = std::filesystem;

const char* const kPlaces =
    "        - {x_m: 1.3, y_m: 0.0, z_m: 0.42, yaw_deg: 180}\n"
    "        - {x_m: 1.2, y_m: -0.4, z_m: 0.42, yaw_deg: -160, tilt_deg: 20}\n"
    "        - {x_m: 1.3, y_m: 0.45, z_m: 0.42, yaw_deg: 155, tilt_deg: 30}\n"
    "        - {x_m: 1.6, y_m: 0.1, z_m: 0.42, yaw_deg: 180, tilt_deg: 42}\n"
    "        - {x_m: 1.3, y_m: -0.1, z_m: 0.42, yaw_deg: 148, tilt_deg: 5}\n"
    "        - {x_m: 1.4, y_m: 0.2, z_m: 0.42, yaw_deg: -150, tilt_deg: 25}\n";
const char* const kParallel =
    "        - {x_m: 1.3, y_m: 0.0, z_m: 0.42, yaw_deg: 180, tilt_deg: 15}\n"
    "        - {x_m: 1.7, y_m: 0.3, z_m: 0.42, yaw_deg: 180, tilt_deg: 15}\n";

// A board in the void and a camera of few pixels: quick.
fs::path scenario(const fs::path& folder, const std::string& places) {
  fs::copy_file(repository() / "scenes/agiprobot/board.glb", folder / "board.glb", fs::copy_options::overwrite_existing);
  fs::copy_file(repository() / "scenes/agiprobot/block.glb", folder / "block.glb", fs::copy_options::overwrite_existing);
  write_file(folder / "scenario.yaml",
             "name: bench\nmodels: [{file: block.glb, x_m: -3}]\n"
             "lighting: {ambient: [0.8, 0.8, 0.8], background: [0.3, 0.3, 0.3]}\n"
             "robot:\n  drive: {model: exact}\n  route: [{x_m: 0, y_m: 0, heading_deg: 0, wait_s: 7.2}]\n"
             "motion:\n  held:\n    - file: board.glb\n      hold_s: 1.0\n      move_s: 0.2\n      places:\n" +
                 places +
                 "sensors:\n  cameras:\n    camera:\n      preset: ideal\n      width: 800\n      height: 450\n      rate_hz: 6\n"
                 "      mount: {z_m: 1.4, pitch_deg: 45, bracket: {position_sigma_m: 0.02, angle_sigma_deg: 1.0}}\n"
                 "  lasers:\n    laser: {preset: sick_s300}\n");
  return folder / "scenario.yaml";
}

class CalibrateTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::waretwin("calibrate nowhere.yaml --out " + in_quotes(folder.path() / "x")).err.find("without Ceres") != std::string::npos) {
      GTEST_SKIP() << "built without Ceres";
    }
  }
  TemporaryFolder folder;
};

TEST_F(CalibrateTest, FindsTheBracketFromScenarioAndRecordingAlike) {
  const fs::path hall = scenario(folder.path(), kPlaces), live = folder.path() / "live.yaml", recorded = folder.path() / "recorded.yaml";
  const auto found = test::waretwin("calibrate " + in_quotes(hall) + " --quiet --intrinsics --seed 4 --out " + in_quotes(live));
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_NE(found.out.find("6 of 6 board poses used"), std::string::npos) << found.out;
  EXPECT_NE(found.out.find("against the truth: "), std::string::npos) << found.out;
  EXPECT_NE(found.out.find("  fx "), std::string::npos) << found.out;
  const Json report = Json::parse(read_file(live.string() + ".report.json"));
  // Six poses of a second each; scenes/agiprobot/calibration.yaml has 20 of two.
  EXPECT_LT(report["error"]["e_trans_m"].get<double>(), 0.01);
  EXPECT_LT(report["error"]["e_rot_deg"].get<double>(), 0.3);
  EXPECT_GT(report["error_before"]["e_trans_m"].get<double>(), 0.01);
  EXPECT_NEAR(report["range_bias_m"].get<double>(), report["truth"]["range_bias_m"].get<double>(), 0.006);
  EXPECT_EQ(read_file(live).find("truth"), std::string::npos) << "the estimate does not know it";

  const fs::path recording = folder.path() / "recording";
  const auto record = test::waretwin("record " + in_quotes(hall) + " --quiet --seed 4 --out " + in_quotes(recording));
  ASSERT_EQ(record.exit_code, 0) << record.err;
  const auto again = test::waretwin("calibrate " + in_quotes(recording) + " --quiet --threads 1 --out " + in_quotes(recorded));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto numbers = [](const fs::path& file) {
    const std::string text = read_file(file);
    return text.substr(text.find('\n'));
  };
  EXPECT_EQ(numbers(live), numbers(recorded)) << "all but the first line, which names the source";
  EXPECT_EQ(again.out.find("truth"), std::string::npos) << again.out;

  EXPECT_ONE_LINE(test::waretwin("calibrate " + in_quotes(recording) + " --quiet --seed 1 --out " + in_quotes(recorded)), "--seed");
}

TEST_F(CalibrateTest, RefusesParallelBoardsInOneLine) {
  const fs::path hall = scenario(folder.path(), kParallel), out = folder.path() / "e.yaml";
  const auto result = test::waretwin("calibrate " + in_quotes(hall) + " --quiet --set robot.route.0.wait_s=2.5 --out " + in_quotes(out));
  EXPECT_ONE_LINE(result, "2 board poses with parallel boards");
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(CalibrateTest, RefusesBadInputInOneLine) {
  const std::string out = " --quiet --out " + in_quotes(folder.path() / "e.yaml");
  EXPECT_ONE_LINE(test::waretwin("calibrate " + agiprobot() + out + " --board 9"), "--board 9: expected inner corners");
  EXPECT_ONE_LINE(test::waretwin("calibrate " + agiprobot() + out + " --square -1"), "--square");
  EXPECT_ONE_LINE(test::waretwin("calibrate " + agiprobot() + " --out " + in_quotes(folder.path())), "is a folder");
  EXPECT_ONE_LINE(test::waretwin("calibrate " + agiprobot() + " --out " + in_quotes(folder.path() / "no/e.yaml")), "there is no folder");
  EXPECT_ONE_LINE(test::waretwin("calibrate " + in_quotes(scenario(folder.path(), kPlaces)) + out + " --laser rear"),
                  "calibrate.laser: 'rear'");
  EXPECT_ONE_LINE(test::waretwin("calibrate " + agiprobot() + out + " --set calibrate.boards.rows=3"), "calibrate.board");
  EXPECT_ONE_LINE(test::waretwin("calibrate nowhere.yaml" + out), "nowhere.yaml");
}

// True boxes, poses, depth and association: nothing but the camera's place is wrong.
Json mapped(const std::string& options, const fs::path& out) {
  std::string command =
      "run " + agiprobot() + " --quiet --profile paper --detector truth --poses truth --depth truth --association truth --frames 6";
  for (const char* quick : {"sensors.cameras.camera.rate_hz=1", "sensors.cameras.camera.width=480", "sensors.cameras.camera.height=270",
                            "simulation.colour=false", "robot.drive.model=exact", "mapper.integrate.voxel_m=0.06", "extras.pictures=false",
                            "extras.depth=false", "extras.surface=false", "extras.visible_share=false", "truth_frames.enabled=false"}) {
    command += std::string(" --set ") + quick;
  }
  const auto result = test::waretwin(command + " --out " + in_quotes(out) + options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.exit_code == 0 ? Json::parse(read_file(out / "cuboids.json"))["objects"] : Json();
}

TEST(Extrinsics, AShiftedCameraShiftsTheMapByAsMuch) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "extrinsics.yaml";
  // As mounted (45 deg down, 1.4 m high), but higher. A hand-made file needs no more.
  const auto write = [&](double z) {
    write_file(file,
               "camera: camera\nlaser: laser\nX_BL: [0.7205511116803305, -0.6934018282758129, 0, 0.275, 0.6934018282758129, "
               "0.7205511116803305, 0, 0.2, 0, 0, 1, 0.3]\nX_BC: [0, -0.7071067811865476, 0.7071067811865476, 0, -1, 0, 0, 0, 0, "
               "-0.7071067811865476, -0.7071067811865476, " +
                   std::to_string(z) + "]\n");
  };
  const std::string option = " --extrinsics " + in_quotes(file);
  const Json plain = mapped("", folder.path() / "plain");
  write(1.52);
  const Json higher = mapped(option, folder.path() / "higher");
  ASSERT_FALSE(plain.empty());
  ASSERT_EQ(plain.size(), higher.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = plain[i]["centre"][axis].get<double>();
      EXPECT_NEAR(higher[i]["centre"][axis].get<double>(), at + (axis == 2 ? 0.12 : 0.0), 0.02);
    }
  }
  // It stands in the run's configuration, which repeats it.
  EXPECT_NE(read_file(folder.path() / "higher/config.yaml").find("extrinsics: " + file.string()), std::string::npos);
  write_file(file,
             "camera: kamera\nlaser: laser\nX_BL: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\nX_BC: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n");
  EXPECT_ONE_LINE(test::waretwin("run " + agiprobot() + " --quiet --out " + in_quotes(folder.path() / "none") + option),
                  "'kamera' is not in");
  EXPECT_ONE_LINE(test::waretwin("map " + in_quotes(folder.path()) + " --quiet --out " + in_quotes(folder.path() / "none") +
                                 " --config x.yaml --extrinsics y.yaml"),
                  "--extrinsics");
  EXPECT_FALSE(fs::exists(folder.path() / "none"));
}

}  // namespace
}  // namespace waretwin
