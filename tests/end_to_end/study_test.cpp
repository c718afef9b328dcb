// `waretwin study` as a user calls it, also as several processes at once.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using test::in_quotes;
using test::ProgramResult;

class Studies : public ::testing::Test {
 protected:
  Studies() {
    write_file(path("study.yaml"),
               "study:\n  halls: {room: {generate: {style: flat, seed: 3, coverage: 0}}}\n  seeds: [1, 2]\n"
               "  run: {detector: truth, poses: truth, depth: truth, frames: 3, set: [simulation.colour=false]}\n"
               "  vary: {height: {key: sensors.cameras.camera.mount.z_m, values: [1.0, 1.2]}}\n"
               "  coverage: {floor_spacing_m: 0.2, points_per_object: 200, place_spacing_m: 1}\n");
  }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  ProgramResult study(const std::string& out, const std::string& more = "", const std::string& prefix = "") const {
    return test::waretwin("study " + in_quotes(path("study.yaml")) + " --quiet --out " + in_quotes(path(out)) + " " + more, prefix);
  }
  int units(const std::string& out) const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(path(out) / "units")) {
      // One that is being written has a dot before its name; kill -9 may leave it.
      const fs::path& file = entry.path();
      count += file.extension() == ".json" && !file.filename().string().starts_with(".") ? 1 : 0;
    }
    return count;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Studies, SaysWhichMountIsBest) {
  const ProgramResult result = study("out");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("best: c00"), std::string::npos) << result.out;
  EXPECT_TRUE(fs::exists(path("out/best/room.yaml")));
  const ProgramResult again = study("out");
  EXPECT_NE(again.out.find("6 runs were there already"), std::string::npos) << again.out;
}

TEST_F(Studies, ProcessesSideBySideMakeTheSameBytes) {
  ASSERT_EQ(study("whole").exit_code, 0);
  // Overlapping on purpose: the second does all, the first its half.
  ProgramResult first;
  std::thread other([&] { first = study("parts", "--shard 0/2 --threads 1"); });
  const ProgramResult second = study("parts", "--threads 1");
  other.join();
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(study("parts", "--merge").exit_code, 0);
  for (const char* name : {"results.json", "results.csv", "runs.csv", "study.md"})
    EXPECT_EQ(read_file(path("parts") / name), read_file(path("whole") / name)) << name;
  EXPECT_EQ(units("parts"), units("whole"));
}

TEST_F(Studies, AKilledOneLosesNothingThatWasDone) {
  ASSERT_EQ(study("whole").exit_code, 0);
  // kill -9 as soon as the third unit of six drives is there.
  std::thread killer([&] {
    const fs::path folder = path("killed/units");
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (std::chrono::steady_clock::now() < give_up) {
      if (fs::exists(folder) && units("killed") >= 3 + 3) break;  // coverage of three candidates, and three drives
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const auto pid = path("pid").string();
    const pid_t process = fs::exists(pid) ? std::atoi(read_file(pid).c_str()) : 0;
    if (process > 0) ::kill(process, SIGKILL);
  });
  // The shell leaves its number and becomes the program.
  study("killed", "", "echo $$ >" + in_quotes(path("pid")) + "; exec");
  killer.join();
  EXPECT_FALSE(fs::exists(path("killed/results.json")));
  const int done = units("killed");
  const ProgramResult again = study("killed");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find(std::to_string(done - 3) + " runs were there already"), std::string::npos) << again.out;
  EXPECT_EQ(read_file(path("killed/results.json")), read_file(path("whole/results.json")));
}

TEST_F(Studies, PreviewAndCoverageDriveNothing) {
  const ProgramResult preview = study("out", "--preview");
  EXPECT_EQ(preview.exit_code, 0) << preview.err;
  EXPECT_NE(preview.out.find("3 candidates drawn"), std::string::npos) << preview.out;
  const ProgramResult coverage = study("out", "--coverage --set study.judge.confidence=0.9");
  EXPECT_EQ(coverage.exit_code, 0) << coverage.err;
  EXPECT_EQ(units("out"), 3);
}

TEST_F(Studies, BadInputIsOneLine) {
  EXPECT_ONE_LINE(study("out", "--shard 2/2"), "expected I/N");
  EXPECT_ONE_LINE(study("out", "--merge"), "units of the study are missing");
  EXPECT_ONE_LINE(study("out", "--set study.pionts=3"), "points");
  EXPECT_ONE_LINE(study("out", "--set study.judge.best_by=beauty"), "best_by");
  EXPECT_ONE_LINE(test::waretwin("study none.yaml --out " + in_quotes(path("out"))), "none.yaml");
  write_file(path("file"), "");
  EXPECT_ONE_LINE(study("file"), "file");
}

}  // namespace
}  // namespace waretwin
