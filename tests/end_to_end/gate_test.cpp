// Gates as a pipeline calls them: exit codes, files, and the templates that are copied into other people's CI.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using test::in_quotes;
using test::ProgramResult;

// A second or less: a bare room, true boxes and poses, a few frames.
std::string quick_run(const std::string& name, const std::string& pass) {
  return "    " + name +
         ": {generate: {style: flat, seed: 3, coverage: 0}, detector: truth, poses: truth, depth: truth, frames: 4, pass: {" + pass +
         "}}\n";
}

class Gates : public ::testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  std::string quoted(const std::string& name) const { return in_quotes(path(name)); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(read_file(path(name))); }

  // A drive of a few frames through the AgiProbot hall.
  ProgramResult run(const std::string& out, const std::string& more) const {
    return test::waretwin("run " + test::agiprobot() + " --out " + quoted(out) +
                          " --quiet --detector truth --poses truth --frames 4 --set sensors.cameras.camera.rate_hz=1 " + more);
  }

  test::TemporaryFolder folder_;
};

TEST_F(Gates, ARunIsHeldAgainstAnEarlierOne) {
  ASSERT_EQ(run("main", "").exit_code, 0);
  const ProgramResult same = run("same", "--baseline " + quoted("main/score.json") + " --junit " + quoted("same.xml"));
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_NE(same.out.find("the same to the last bit"), std::string::npos) << same.out;
  EXPECT_NE(read_file(path("same.xml")).find("failures=\"0\""), std::string::npos);

  nlohmann::json best = json("main/score.json");
  best["surface"]["found"] = 1.0;
  write_file(path("best.json"), best.dump());
  const ProgramResult worse = run("worse", "--baseline " + quoted("best.json") + " --junit " + quoted("worse.xml"));
  EXPECT_EQ(worse.exit_code, 1) << worse.err;
  EXPECT_NE(worse.out.find("**worse**"), std::string::npos);
  EXPECT_NE(read_file(path("worse/baseline.md")).find("| surface_found"), std::string::npos);
  EXPECT_TRUE(fs::exists(path("worse/score.json")));
  EXPECT_NE(read_file(path("worse.xml")).find("failures=\"1\""), std::string::npos);
}

TEST_F(Gates, TwoScoresAreCompared) {
  const char* const kScore = R"({"schema": 1, "summary": {"recall": 1.0, "mean_iou3d": 0.95}, "objects": []})";
  write_file(path("a.json"), kScore);
  make_folder(path("b"));
  write_file(path("b/score.json"), R"({"schema": 1, "summary": {"recall": 1.0, "mean_iou3d": 0.90}, "objects": []})");
  const std::string both = "compare " + quoted("a.json") + " " + quoted("b");
  const ProgramResult worse = test::waretwin(both + " --junit " + quoted("c.xml"));
  EXPECT_EQ(worse.exit_code, 1);
  EXPECT_NE(worse.out.find("| mean_iou3d |"), std::string::npos) << worse.out;
  EXPECT_NE(read_file(path("c.xml")).find("mean_iou3d was 0.9500, is 0.9000, may get worse by 0.005"), std::string::npos);
  EXPECT_EQ(test::waretwin("compare " + quoted("b") + " " + quoted("a.json")).exit_code, 0);
  write_file(path("t.yaml"), "tolerances: {mean_iou3d: 0.06}\n");
  EXPECT_EQ(test::waretwin(both + " --tolerances " + quoted("t.yaml")).exit_code, 0);
  EXPECT_EQ(test::waretwin(both + " --tolerances " + quoted("t.yaml") + " --set tolerances.mean_iou3d=0.04").exit_code, 1);
  EXPECT_ONE_LINE(test::waretwin(both + " --set tolerances.mean_iou=1"), "mean_iou3d");
  EXPECT_ONE_LINE(test::waretwin(both + " --set tolerances.recall=-1"), "tolerances.recall");
  EXPECT_ONE_LINE(test::waretwin("compare " + quoted("a.json") + " " + quoted("t.yaml")), "is not JSON");
}

TEST_F(Gates, ASuiteEndsWithItsVerdict) {
  write_file(path("suite.yaml"), "suite:\n  runs:\n" + quick_run("a", "contacts: 0"));
  const std::string command = "run --quiet --suite " + quoted("suite.yaml") + " --out " + quoted("out");
  const ProgramResult passed = test::waretwin(command);
  EXPECT_EQ(passed.exit_code, 0) << passed.err;
  EXPECT_NE(passed.out.find("| a   | passed"), std::string::npos) << passed.out;
  EXPECT_NE(test::waretwin(command).out.find("1 runs were there already"), std::string::npos);

  write_file(path("suite.yaml"), "suite:\n  runs:\n" + quick_run("a", "contacts: 0") + quick_run("b", "surface_found: 1"));
  const ProgramResult failed = test::waretwin(command);
  EXPECT_EQ(failed.exit_code, 1) << failed.err;
  EXPECT_NE(failed.out.find("b: surface_found 0."), std::string::npos) << failed.out;

  EXPECT_EQ(test::waretwin(command + " --shard 0/2").exit_code, 1);  // all there
  EXPECT_ONE_LINE(test::waretwin("run --merge --suite " + quoted("suite.yaml") + " --out " + quoted("none")),
                  "runs of the suite are missing: a, b");
  EXPECT_ONE_LINE(test::waretwin(command + " --shard 2/2"), "expected I/N");
  EXPECT_ONE_LINE(test::waretwin(command + " --profile paper"), "--profile excludes --suite");
  EXPECT_ONE_LINE(test::waretwin("run --out " + quoted("none")), "expected SCENARIO, or --suite");
}

// The lines of a template, as its service's shell gets them, in a project of somebody's: a suite, and waretwin beside it.
class Templates : public Gates {
 protected:
  void SetUp() override {
    make_folder(path("waretwin/build/release"));
    fs::create_directory_symlink(fs::path(WARETWIN_PROGRAM).parent_path(), path("waretwin/build/release/harness"));
  }
  static YAML::Node read(const char* name) { return YAML::LoadFile((test::repository() / "ci/templates" / name).string()); }
  void write_suite(const std::string& pass) {
    write_file(path("suite.yaml"), "suite:\n  runs:\n" + quick_run("a", "contacts: 0") + quick_run("b", pass));
    fs::remove_all(path("out"));
  }
  // Its exit code; `settings` are variables that the service sets.
  int shell(const std::string& line, const std::string& settings) const {
    const std::string command = "cd " + in_quotes(folder_.path()) + " && export " + settings + " && { " + line + "; } >log 2>&1";
    write_file(path("line.sh"), command + "\n");
    const int status = std::system(("bash -e " + quoted("line.sh")).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(Templates, GitHubDrivesAndSaysWhatBecameOfIt) {
  const YAML::Node job = read("github-actions.yml")["jobs"]["suite"];
  const auto step = [&](const std::string& name) {
    for (const YAML::Node& one : job["steps"]) {
      if (one["name"] && one["name"].as<std::string>() == name) return one["run"].as<std::string>();
    }
    ADD_FAILURE() << "no step " << name;
    return std::string();
  };
  const std::string settings = "WARETWIN=" + job["env"]["WARETWIN"].as<std::string>() + " GITHUB_STEP_SUMMARY=summary.md";
  for (const bool good : {true, false}) {
    write_suite(good ? "contacts: 0" : "surface_found: 1");
    EXPECT_EQ(shell(step("Drive"), settings), good ? 0 : 1) << read_file(path("log"));
    EXPECT_EQ(shell(step("Say what became of it"), settings), 0);
    EXPECT_NE(read_file(path("summary.md")).find(good ? "| b   | passed" : "- b: surface_found"), std::string::npos);
  }
  for (const char* script : {"ci/install.sh", "ci/build.sh"}) {
    EXPECT_NE(step("Build").find(script), std::string::npos);
    EXPECT_TRUE(fs::exists(test::repository() / script));
  }
}

TEST_F(Templates, GitLabDrivesInPartsAndJudgesTheWhole) {
  const YAML::Node file = read("gitlab-ci.yml");
  const auto script = [&](const char* job) { return file[job]["script"][0].as<std::string>(); };
  const int parts = file["drive"]["parallel"].as<int>();
  for (const bool good : {true, false}) {
    write_suite(good ? "contacts: 0" : "surface_found: 1");
    for (int part = 1; part <= parts; ++part) {
      EXPECT_EQ(shell(script("drive"), "CI_NODE_INDEX=" + std::to_string(part) + " CI_NODE_TOTAL=" + std::to_string(parts)), 0)
          << read_file(path("log"));
    }
    EXPECT_EQ(shell(script("judge"), "X=1"), good ? 0 : 1) << read_file(path("log"));
    EXPECT_NE(
        read_file(path(file["judge"]["artifacts"]["reports"]["junit"].as<std::string>())).find(good ? "failures=\"0\"" : "failures=\"1\""),
        std::string::npos);
  }
}

}  // namespace
}  // namespace waretwin
