#include "tests/end_to_end/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace waretwin {
namespace {

using test::agiprobot;
using test::TemporaryFolder;

TEST(Program, ExplainsItself) {
  const auto top = test::waretwin("--help");
  EXPECT_EQ(top.exit_code, 0);
  for (const char* command : {"run", "map", "record", "score", "render", "inspect", "generate", "detect"}) {
    EXPECT_NE(top.out.find(command), std::string::npos) << command;
    const auto help = test::waretwin(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    for (const char* word : {"Example", "--seed", "--threads", "--set", "--quiet"}) {
      EXPECT_NE(help.out.find(word), std::string::npos) << command << " " << word;
    }
  }
  const auto version = test::waretwin("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_NE(version.out.find("waretwin "), std::string::npos);
}

TEST(Program, RefusesWhatItDoesNotKnowInOneLine) {
  EXPECT_ONE_LINE(test::waretwin("runn"), "runn");
  EXPECT_ONE_LINE(test::waretwin(""), "subcommand");
  EXPECT_ONE_LINE(test::waretwin("run x.yaml --out o --profil paper"), "--profil");
  EXPECT_ONE_LINE(test::waretwin("run x.yaml --out o --profile papr"), "papr");
  EXPECT_ONE_LINE(test::waretwin("run x.yaml --out o --threads many"), "many");
  EXPECT_ONE_LINE(test::waretwin("run --out o"), "SCENARIO");
  EXPECT_ONE_LINE(test::waretwin("run x.yaml --out o --rate nan"), "0 to 1000");
  EXPECT_ONE_LINE(test::waretwin("run x.yaml --out o --frames -1"), "whole number");
  EXPECT_ONE_LINE(test::waretwin("run x.yaml --out o --seed -1"), "whole number");
  EXPECT_ONE_LINE(test::waretwin("render " + agiprobot() + " --out o.jpg"), ".png");
  EXPECT_ONE_LINE(test::waretwin("render " + agiprobot() + " --out o.png --time 1000"), "--time");
  EXPECT_ONE_LINE(test::waretwin("render model.glb --out o.png --time 1 --pose 0,0,0,0,0"), "--");
}

TEST(Program, GeneratesAHallThatItRuns) {
  const TemporaryFolder folder;
  const std::string hall = "'" + (folder.path() / "hall").string() + "'";
  const auto made = test::waretwin("generate --style flat --conveyors 2 --seed 4 --out " + hall);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.err, "");
  for (const char* text : {"flat_4", "2 conveyors", "% seen", "route: ", "plan.png"}) {
    EXPECT_NE(made.out.find(text), std::string::npos) << text << " in: " << made.out;
  }
  const auto inspected = test::waretwin("inspect " + hall + "/scenario.yaml --motion 20 --quiet");
  EXPECT_EQ(inspected.exit_code, 0) << inspected.out;
  const auto run = test::waretwin("run " + hall + "/scenario.yaml --frames 3 --quiet --out '" + (folder.path() / "out").string() + "'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(Program, SaysWhyItCannotGenerateAHall) {
  const TemporaryFolder folder;
  const std::string out = " --quiet --out '" + (folder.path() / "hall").string() + "'";
  EXPECT_ONE_LINE(test::waretwin("generate"), "--out");
  EXPECT_ONE_LINE(test::waretwin("generate --style castle" + out), "castle");
  EXPECT_ONE_LINE(test::waretwin("generate --size 12" + out), "12x6");
  EXPECT_ONE_LINE(test::waretwin("generate --size 12x6m" + out), "12x6m");
  EXPECT_ONE_LINE(test::waretwin("generate --size nanx6" + out), "nanx6");
  EXPECT_ONE_LINE(test::waretwin("generate --size 3x8" + out), "4x4");
  EXPECT_ONE_LINE(test::waretwin("generate --conveyors 0" + out), "--conveyors");
  EXPECT_ONE_LINE(test::waretwin("generate --coverage 1.5" + out), "0.95");
  EXPECT_ONE_LINE(test::waretwin("generate --size 5x4.5 --conveyors 12" + out), "12 conveyors");
  EXPECT_ONE_LINE(test::waretwin("generate --style home --conveyors 5" + out), "conveyors 5: a home has none");
  EXPECT_ONE_LINE(test::waretwin("generate --set generate.cluter=1" + out), "clutter");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "bad input leaves nothing behind";
}

TEST(Program, NamesAMissingFile) {
  const TemporaryFolder folder;
  const std::string out = " --out '" + folder.path().string() + "/out'";
  EXPECT_ONE_LINE(test::waretwin("run nowhere.yaml" + out), "nowhere.yaml");
  EXPECT_ONE_LINE(test::waretwin("map nowhere" + out), "nowhere");
  EXPECT_ONE_LINE(test::waretwin("render nowhere.glb --out '" + folder.path().string() + "/out.png'"), "nowhere.glb");
  EXPECT_ONE_LINE(test::waretwin("inspect nowhere.glb"), "nowhere.glb");
  EXPECT_ONE_LINE(test::waretwin("score nowhere.json --truth nothing.json"), "nowhere.json");
  EXPECT_ONE_LINE(test::waretwin("run " + agiprobot() + out + " --detector nowhere.cfg"), "nowhere.cfg");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out")) << "bad input leaves nothing behind";
}

TEST(Program, NamesTheNearestKey) {
  const TemporaryFolder folder;
  const std::string run = "run " + agiprobot() + " --out '" + folder.path().string() + "/out' --set ";
  EXPECT_ONE_LINE(test::waretwin(run + "mapper.integrate.voxel_n=0.02"), "voxel_m");
  EXPECT_ONE_LINE(test::waretwin(run + "maper.rate_hz=1"), "mapper");
  EXPECT_ONE_LINE(test::waretwin(run + "mapper.rate_hz=fast"), "fast");
  EXPECT_ONE_LINE(test::waretwin(run + "mapper.rate_hz"), "=");
  const TemporaryFolder copy;
  std::filesystem::copy(test::repository() / "scenes/agiprobot", copy.path() / "hall", std::filesystem::copy_options::recursive);
  {
    std::ofstream scenario(copy.path() / "hall/scenario.yaml", std::ios::app);
    scenario << "\nrobott: {}\n";
  }
  const auto result =
      test::waretwin("run '" + (copy.path() / "hall/scenario.yaml").string() + "' --out '" + folder.path().string() + "/out'");
  EXPECT_ONE_LINE(result, "robot");
  EXPECT_NE(result.err.find("scenario.yaml:"), std::string::npos) << "file and line: " << result.err;
}

TEST(Program, NamesATruncatedModel) {
  const TemporaryFolder copy;
  std::filesystem::copy(test::repository() / "scenes/agiprobot", copy.path() / "hall", std::filesystem::copy_options::recursive);
  const std::filesystem::path model = copy.path() / "hall/hall.glb";
  std::filesystem::resize_file(model, std::filesystem::file_size(model) / 2);
  EXPECT_ONE_LINE(test::waretwin("inspect '" + model.string() + "'"), model.filename().string());
  EXPECT_ONE_LINE(test::waretwin("run '" + (copy.path() / "hall/scenario.yaml").string() + "' --out '" + copy.path().string() + "/out'"),
                  model.filename().string());
}

TEST(Program, NoticesAFullDisk) {
  // A limit on the size of files stands for a full disk; the shell counts in blocks of 512 or 1024 bytes.
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "picture.png").string();
  const auto limited = test::waretwin("render " + agiprobot() + " --size 320x180 --out '" + out + "'", "ulimit -f 4; trap '' XFSZ;");
  EXPECT_ONE_LINE(limited, "picture.png");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing half-written is left";
  EXPECT_ONE_LINE(test::waretwin("render " + agiprobot() + " --size 320x180 --out /dev/full/picture.png"), "/dev/full");
}

TEST(Program, NoticesADiskThatFillsUpDuringARun) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  // Large enough for the small files that come first, too small for the map.
  const std::string limit = "ulimit -f 64; trap '' XFSZ;";
  const auto run = test::waretwin(
      "run " + agiprobot() + " --out '" + out.string() + "' --quiet --profile paper --frames 2 --set simulation.colour=false", limit);
  EXPECT_ONE_LINE(run, out.string());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
    if (!entry.is_regular_file()) continue;
    EXPECT_LT(entry.file_size(), 64u * 512u) << entry.path() << " is half-written";
  }
  EXPECT_FALSE(std::filesystem::exists(out / "score.json")) << "the score is written last";

  WARETWIN_NEED_DATA("rgbd_sun3d");
  const auto map =
      test::waretwin("map '" + test::shared_data("rgbd_sun3d").string() + "' --out '" + out.string() + "' --quiet --frames 1", limit);
  EXPECT_ONE_LINE(map, out.string());
}

TEST(Program, RefusesOptionsThatAConfigurationSettles) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "config.yaml";
  write_file(file, "mapper:\n  rate_hz: 1\n  voxel: 3\n");
  const std::string run = "run " + agiprobot() + " --out '" + folder.path().string() + "/out' --config '" + file.string() + "' ";
  EXPECT_ONE_LINE(test::waretwin(run + "--profile paper"), "--profile");
  EXPECT_ONE_LINE(test::waretwin(run), "config.yaml:3");
  EXPECT_ONE_LINE(test::waretwin("run " + agiprobot() + " --out x --config none.yaml"), "none.yaml");
}

TEST(Program, RendersAPicture) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "picture.png").string();
  const auto result = test::waretwin("render " + agiprobot() + " --size 320x180 --pose=0,0,1.5,90,20 --out '" + out + "'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(read_file(out).starts_with("\x89PNG"));
}

TEST(Program, ListsTheKeys) {
  const auto result = test::waretwin("inspect " + agiprobot() + " --keys");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* key : {"voxel_m", "rate_hz", "truth_depth", "route", "min_visible_fraction"}) {
    EXPECT_NE(result.out.find(key), std::string::npos) << key;
  }
  EXPECT_EQ(test::waretwin("inspect " + agiprobot()).exit_code, 0);
}

TEST(Program, ScoresListsAndTrajectories) {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return "'" + (folder.path() / name).string() + "'"; };
  write_file(folder.path() / "cuboids.json", R"({"objects":[{"id":9,"class":"c","centre":[0.4,0,0.5],"yaw":0,"size":[2,1,1]}]})");
  write_file(folder.path() / "truth.json", R"({"objects":[{"id":1,"class":"c","centre":[0,0,0.5],"yaw":0,"size":[2,1,1]}]})");
  const auto lists = test::waretwin("score " + at("cuboids.json") + " --truth " + at("truth.json") + " --out " + at("score"));
  EXPECT_EQ(lists.exit_code, 0) << lists.err;
  EXPECT_NE(lists.out.find("| 1 | 9 | 0.6667 | 0.400 | 0.0 |"), std::string::npos) << lists.out;
  const auto json = nlohmann::json::parse(read_file(folder.path() / "score/score.json"));
  EXPECT_NEAR(json["summary"]["mean_iou3d"].get<double>(), 1.6 / 2.4, 1e-12);

  write_file(folder.path() / "a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 1 1 0 0 0 0 1\n");
  write_file(folder.path() / "b.tum", "0 0 0 3 0 0 0 1\n1 1 0 3 0 0 0 1\n2 1 1 3 0 0 0 1\n");
  const auto trajectories = test::waretwin("score " + at("a.tum") + " --truth " + at("b.tum"));
  EXPECT_EQ(trajectories.exit_code, 0) << trajectories.err;
  const auto ate = nlohmann::json::parse(trajectories.out);
  EXPECT_NEAR(ate["trajectory"]["ate_rmse_m"].get<double>(), 0.0, 1e-9) << "aligned";
  EXPECT_NEAR(ate["trajectory"]["ate_unaligned_rmse_m"].get<double>(), 3.0, 1e-9);
  EXPECT_ONE_LINE(test::waretwin("score " + at("a.tum") + " --truth " + at("truth.json")), "truth.json");
}

TEST(Program, ReportsWhatTheVehicleTouches) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  // Straight into station 1, whose conveyor is mapped all the same.
  const auto run =
      test::waretwin("run " + agiprobot() + " --out '" + out + "' --profile paper --detector none --quiet " +
                     "--set sensors.cameras.camera.rate_hz=1 --set robot.route.1.x_m=-1.6 --set robot.route.1.y_m=-1.9 --frames 6");
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.err.find("the vehicle touched"), std::string::npos) << run.err;
  const auto score = nlohmann::json::parse(read_file(folder.path() / "out/score.json"));
  ASSERT_FALSE(score["motion"]["contacts"].empty());
  const auto& contact = score["motion"]["contacts"][0];
  EXPECT_GT(contact["begin_s"].get<double>(), 1.0);
  EXPECT_LT(std::abs(contact["y_m"].get<double>() + 1.6), 0.4) << "at the cabinet's front";
}

TEST(Program, WritesAnOctomapWhereItCan) {
#ifdef WARETWIN_OCTOMAP
  constexpr bool kAvailable = true;
#else
  constexpr bool kAvailable = false;
#endif
  const TemporaryFolder folder;
  const auto out = folder.path() / "out", file = out / "octomap.bt";
  const std::string run = "run " + agiprobot() + " --out '" + out.string() +
                          "' --quiet --profile paper --detector none --frames 1 --set simulation.colour=false --set output.octomap=";
  const auto first = test::waretwin(run + "auto");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.err, "") << "OctoMap says nothing";
  EXPECT_EQ(std::filesystem::exists(file), kAvailable);
  EXPECT_EQ(read_file(out / "report.html").find("octomap.bt") != std::string::npos, kAvailable);
  if (kAvailable) {
    EXPECT_TRUE(read_file(file).starts_with("# Octomap OcTree binary file\n"));
  }
  ASSERT_EQ(test::waretwin(run + "never").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(file)) << "an earlier run's is taken away";
  EXPECT_EQ(read_file(out / "report.html").find("octomap.bt"), std::string::npos);
  if (kAvailable) {
    ASSERT_EQ(test::waretwin(run + "always").exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(file));
  } else {
    EXPECT_ONE_LINE(test::waretwin(run + "always"), "liboctomap-dev");
    EXPECT_ONE_LINE(test::waretwin(run + "always"), "output.octomap");
  }
}

TEST(Program, InspectsWhatMoves) {
  const auto busy = "'" + (test::repository() / "scenes/agiprobot/busy.yaml").string() + "'";
  const auto first = test::waretwin("inspect " + busy + " --motion 4 --quiet");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  for (const char* part : {"conveyor_1", "1 came in", "the vehicle touched nothing", "digest "}) {
    EXPECT_NE(first.out.find(part), std::string::npos) << first.out;
  }
  EXPECT_EQ(first.out, test::waretwin("inspect " + busy + " --motion 4 --quiet --threads 1").out);
  EXPECT_ONE_LINE(test::waretwin("inspect " + busy + " --motion soon"), "soon");
  EXPECT_ONE_LINE(test::waretwin("inspect " + busy + " --motion 4 --set motion.belts.0.object=conveyor_9"), "conveyor_9");
  EXPECT_ONE_LINE(test::waretwin("inspect '" + (test::repository() / "scenes/agiprobot/hall.glb").string() + "' --motion 4"), "--motion");
}

}  // namespace
}  // namespace waretwin
