#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::agiprobot;
using test::in_quotes;
using test::TemporaryFolder;
using Json = nlohmann::json;
namespace fs = std::filesystem;

// Any text as one word of a shell's line.
std::string as_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

// A quick drive, recorded for `mapper`.
test::ProgramResult run(const fs::path& out, const std::string& mapper, const std::string& options = "") {
  return test::waretwin("run " + agiprobot() +
                        " --quiet --frames 3 --rate 2 --set sensors.cameras.camera.rate_hz=4 --set sensors.cameras.camera.width=320 --set "
                        "sensors.cameras.camera.height=180 --out " +
                        in_quotes(out) + " " + options + " --mapper " + as_word(mapper));
}

TEST(ExternalMapper, ItsCuboidsAndTrajectoryAreScored) {
  const TemporaryFolder folder;
  // A mapper that knows it all: it leaves the truth of another recording of the same hall.
  const fs::path drive = folder.path() / "drive", out = folder.path() / "out with space";
  ASSERT_EQ(test::waretwin("record " + agiprobot() + " --quiet --frames 3 --out " + in_quotes(drive)).exit_code, 0);
  const std::string mapper = "echo working >&2; ls {recording}; ls {recording}/../..; cp \"" + (drive / "truth.json").string() +
                             "\" {out}/cuboids.json; cp \"" + (drive / "trajectory_truth.tum").string() + "\" {out}/trajectory.tum";
  const auto result = run(out, mapper);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json score = Json::parse(read_file(out / "score.json"));
  EXPECT_EQ(score["profile"], "mapper");
  EXPECT_EQ(score["stages"]["poses"], "mapper");
  ASSERT_EQ(score["objects"].size(), 4u);
  for (const Json& object : score["objects"]) EXPECT_NEAR(object["iou3d"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(score["trajectory"]["ate_rmse_m"].get<double>(), 0.0, 1e-6);
  EXPECT_EQ(score["frames"]["simulated"], 2) << "three frames at 4 Hz, of which two are recorded at 2 Hz";
  for (const char* name :
       {"cuboids.json", "truth.json", "trajectory.tum", "trajectory_truth.tum", "table6.md", "topdown.png", "report.html", "config.yaml"}) {
    EXPECT_TRUE(fs::exists(out / name)) << name;
  }
  EXPECT_EQ(read_file(out / "mapper/stderr.log"), "working\n");
  // What it was given holds nothing of the truth.
  const std::string given = read_file(out / "mapper/stdout.log");
  EXPECT_NE(given.find("rgb.txt"), std::string::npos);
  for (const char* word : {"truth", "boxes", "xml", "score"}) EXPECT_EQ(given.find(word), std::string::npos) << given;
  EXPECT_FALSE(fs::exists(out / "mapper/recording")) << "taken away, as nobody asked for it";

  // A gate judges it as any run, and the configuration repeats it.
  const auto again = run(out, mapper, "--baseline " + in_quotes(out / "score.json"));
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
  const auto repeated = test::waretwin("run " + agiprobot() + " --quiet --config " + in_quotes(out / "config.yaml") + " --out " +
                                       in_quotes(folder.path() / "repeated"));
  EXPECT_EQ(repeated.exit_code, 0) << repeated.err;
  EXPECT_EQ(Json::parse(read_file(folder.path() / "repeated/score.json"))["digest"], score["digest"]);
}

TEST(ExternalMapper, TheTruthGoesInWhereItIsAskedFor) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const std::string adapter = "\"" + (test::repository() / "ci/mapper_adapter.sh").string() + "\" {recording} {out} ";
  const fs::path mapper = folder.path() / "mapper.sh";
  write_file(mapper,
             "grep -c detections \"$3\" > \"$2/frames.txt\"\nwc -l < \"$1/trajectory.log\" >> \"$2/frames.txt\"\n"
             "echo '# ours\nconveyor 1 2 0.5 0.1 0.6 0.4 0.2 0.9\nconveyor -1 2 0.5 0 0.6 0.4 .2' > \"$2/boxes.txt\"\n");
  const std::string call = adapter + "sh -c 'exec sh \"" + mapper.string() + "\" \"$1\" \"$2\" {boxes}' x";
  // The words of one shell inside another's are the adapter's user's affair; here the paths hold no quotes.
  const auto result = run(out, call, "--detector truth --poses truth --format scenenn --keep-recording");
  ASSERT_EQ(result.exit_code, 0) << result.err << read_file(out / "mapper/stderr.log");
  EXPECT_EQ(read_file(out / "mapper/out/frames.txt"), "2\n10\n") << "two frames with boxes, two poses of five lines";
  EXPECT_TRUE(fs::exists(out / "mapper/recording/boxes.json"));
  EXPECT_FALSE(fs::exists(out / "mapper/recording/recording.xml")) << "no annotation";
  const Json cuboids = Json::parse(read_file(out / "cuboids.json"));
  ASSERT_EQ(cuboids["objects"].size(), 2u);
  EXPECT_EQ(cuboids["objects"][0]["centre"], (std::vector<double>{1, 2, 0.5}));
  EXPECT_EQ(cuboids["objects"][0]["score"], 0.9);
  EXPECT_EQ(Json::parse(read_file(out / "score.json"))["stages"]["detector"], "truth");
}

TEST(ExternalMapper, ItsFailuresAreToldAndScoreNothing) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const auto failed = run(out, "echo {recording} {out} >/dev/null; echo no model >&2; exit 7");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_NE(failed.err.find("no model"), std::string::npos) << failed.err;
  EXPECT_NE(failed.err.find("exit code 7"), std::string::npos) << failed.err;
  EXPECT_EQ(read_file(out / "mapper/stderr.log"), "no model\n");
  EXPECT_FALSE(fs::exists(out / "score.json"));
  EXPECT_TRUE(fs::exists(out / "mapper/recording")) << "kept, to try again on";

  const auto start = std::chrono::steady_clock::now();
  const auto slow = run(out, "echo {recording} {out}; sleep 300 & sleep 300; wait", "--mapper-timeout 0.5");
  EXPECT_EQ(slow.exit_code, 1);
  EXPECT_NE(slow.err.find("--mapper-timeout"), std::string::npos) << slow.err;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(120)) << "it was not waited for";

  EXPECT_ONE_LINE(run(out, "echo {recording} {out}"), "cuboids.json");
  EXPECT_ONE_LINE(run(out, "echo {recording} {out}; echo '{}' > {out}/cuboids.json"), "objects");
  // A trajectory of another time costs the trajectory's score alone.
  const auto other =
      run(out, "echo {recording}; echo '{\"objects\":[]}' > {out}/cuboids.json; echo '1e9 0 0 0 0 0 0 1' > {out}/trajectory.tum");
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_TRUE(Json::parse(read_file(out / "score.json"))["trajectory"].is_null());
  EXPECT_ONE_LINE(run(out, "my_mapper {recording} {out}", "--budget"), "--budget");
  EXPECT_ONE_LINE(run(out, "my_mapper {recording}"), "{out}");
  EXPECT_ONE_LINE(run(out, "my_mapper {recording} {out} {boxes}"), "--detector truth");
  EXPECT_ONE_LINE(run(out, "my_mapper {recording} {out}", "--detector yolo"), "--detector yolo");
  EXPECT_ONE_LINE(run(out, "my_mapper {recording} {out}", "--poses laser"), "--poses laser");
  EXPECT_ONE_LINE(run(out, "my_mapper {recording} {out}", "--poses truth --format rosbag"), "rosbag");
  EXPECT_ONE_LINE(run(out, "my_mapper {recording} {out}", "--profile paper"), "--profile");
  EXPECT_ONE_LINE(test::waretwin("run " + agiprobot() + " --out o --mapper-timeout 3"), "--mapper");
}

}  // namespace
}  // namespace waretwin
