// Another mapper in suites and studies: a shell line in place of ours, judged as ours is.
#include "harness/run/external_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "core/error.h"
#include "core/files.h"
#include "harness/score/cuboid_file.h"
#include "harness/study/study.h"
#include "harness/suite/suite.h"
#include "harness/truth/true_list.h"
#include "harness/units/run_unit.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

// One small picture of one small thing, that counts though it is hardly seen: what is tested is what becomes of it.
constexpr const char* kHall =
    "name: yard\n"
    "models: [{file: block.glb, x_m: 1.5, class: block}]\n"
    "robot:\n  route: [{x_m: 0, y_m: 0, heading_deg: 0, wait_s: 1}]\n"
    "sensors:\n"
    "  cameras: {camera: {preset: azure_kinect, rate_hz: 4, width: 160, height: 90, mount: {z_m: 1.4, pitch_deg: 45}}}\n"
    "  lasers: {laser: {preset: sick_s300, mount: {x_m: 0.275, z_m: 0.3}}}\n";
const std::string kQuick = "frames: 1, set: [score.min_visible_fraction=0]";

class OtherMapper : public ::testing::Test {
 protected:
  // A mapper that knows it all: it leaves the truth, which was made beforehand.
  void SetUp() override {
    fs::copy_file(test::repository() / "scenes/agiprobot/block.glb", path("block.glb"));
    write_file(path("yard.yaml"), kHall);
    write_file(path("truth.json"), truth_json(true_list(build_scene(load_scenario(path("yard.yaml"))), nullptr)));
  }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  // In a YAML text in double quotes.
  std::string good() const { return "ls {recording}; cp '" + path("truth.json").string() + "' {out}/cuboids.json"; }

  // A run of a suite.
  static std::string run_of(const std::string& name, const std::string& more) {
    return "    " + name + ": {scenario: yard.yaml, " + kQuick + more + "}\n";
  }
  static std::string mapper(const std::string& command, const std::string& more = "") {
    return ", external_mapper: {command: \"" + command + "\"" + more + "}";
  }
  SuiteSummary suite(const std::string& runs, const std::string& out, Shard shard = {}, const SuiteHooks& hooks = {}) const {
    write_file(path("suite.yaml"), "suite:\n  runs:\n" + runs);
    return run_suite({path("suite.yaml"), {}, path(out), shard, false}, hooks);
  }

  StudyRequest study(const std::string& mapper_of_all, const std::string& vary, const std::string& out) const {
    write_file(path("study.yaml"), "study:\n  halls: {room: {scenario: yard.yaml}}\n  run: {" + kQuick + mapper_of_all +
                                       "}\n  vary: {it: {" + vary +
                                       "}}\n"
                                       "  coverage: {floor_spacing_m: 1, points_per_object: 20, place_spacing_m: 4, rate_hz: 0.05}\n");
    StudyRequest request;
    request.file = path("study.yaml");
    request.out = path(out);
    return request;
  }
  static constexpr const char* kHeight = "key: sensors.cameras.camera.mount.z_m, values: [1.2]";

  test::TemporaryFolder folder_;
};

TEST_F(OtherMapper, IsJudgedInASuiteAndItsFailuresAreItsRunsAlone) {
  const std::string runs =
      run_of("ended", mapper("echo {recording} {out}; yes | head -c 100000 >&2; echo no model >&2; exit 7")) +
      run_of("good", mapper(good(), ", keep_recording: true") + ", pass: {recall: 1, mean_iou3d: 0.999}") +
      run_of("loop", mapper("echo {recording}; ln -s cuboids.json {out}/cuboids.json")) +
      run_of("pipe", mapper("echo {recording}; mkfifo {out}/cuboids.json")) +
      run_of("slow", mapper("echo {recording} {out}; sleep 60", ", timeout_s: 0.1")) +
      run_of("unread", mapper("echo {recording}; echo '{}' > {out}/cuboids.json")) +
      run_of("wrong", mapper("echo {recording}; echo '{\\\"objects\\\": []}' > {out}/cuboids.json") + ", pass: {recall: 1}") +
      run_of("wrong_frame", mapper("echo {recording}; sed s/world/map/ '" + path("truth.json").string() + "' > {out}/cuboids.json"));
  const SuiteSummary summary = suite(runs, "out");
  ASSERT_EQ(summary.outcomes.size(), 8u);
  const auto problem = [&](std::size_t i) { return summary.outcomes[i].problems.empty() ? "" : summary.outcomes[i].problems.front(); };
  EXPECT_EQ(problem(0), "the mapper ended with exit code 7, see ended/mapper/stderr.log: no model");
  EXPECT_TRUE(summary.outcomes[1].passed()) << problem(1) << summary.outcomes[1].error;
  EXPECT_EQ(problem(2), "loop/mapper/out/cuboids.json: cannot be looked at: Too many levels of symbolic links");
  EXPECT_EQ(problem(3), "pipe/mapper/out/cuboids.json: is a folder, a pipe or the like; expected a file");
  EXPECT_EQ(problem(4), "the mapper was ended after 0.1 s (external_mapper.timeout_s, --mapper-timeout), see slow/mapper/stderr.log");
  EXPECT_EQ(problem(5), "unread/mapper/out/cuboids.json: key 'objects' is missing");
  EXPECT_EQ(problem(6), "recall 0, expected at least 1");
  EXPECT_EQ(problem(7), "wrong_frame/mapper/out/cuboids.json: its frame is 'map'; expected \"world\", the hall's");
  for (const SuiteOutcome& outcome : summary.outcomes) EXPECT_EQ(outcome.error, "");

  for (const char* name :
       {"score.json", "table6.md", "report.html", "config.yaml", "truth.json", "mapper/stdout.log", "mapper/recording/rgb.txt"})
    EXPECT_TRUE(fs::exists(path("out/good") / name)) << name;
  EXPECT_EQ(read_file(path("out/ended/mapper/stderr.log")).size(), 100009u);
  EXPECT_TRUE(fs::exists(path("out/ended/mapper/recording"))) << "kept, to try again on";
  EXPECT_FALSE(fs::exists(path("out/slow/mapper/recording"))) << "only of the first that fails";
  EXPECT_TRUE(fs::exists(path("out/slow/mapper/stderr.log")));
  EXPECT_FALSE(fs::exists(path("out/wrong/mapper/recording"))) << "taken away, as nobody asked for it";
  EXPECT_FALSE(fs::exists(path("out/ended/score.json")));
  EXPECT_NE(read_file(path("out/junit.xml")).find(R"(tests="8" failures="7" errors="0")"), std::string::npos);
  EXPECT_NE(read_file(path("out/suite.md")).find("- slow: the mapper was ended"), std::string::npos);

  // What has failed is tried again; what was judged, well or not, is not.
  const SuiteSummary again = suite(runs, "out");
  EXPECT_EQ(again.found, 2);
  EXPECT_EQ(again.found_unwatched, 2);
}

TEST_F(OtherMapper, OfTheSuiteIsThatOfRunsThatNameNoOther) {
  const std::string runs = run_of("a", "") + run_of("b", ", external_mapper: {command: 'echo {recording} {out}; exit 3'}");
  const std::string of_all = "  external_mapper: {command: \"" + good() + "\", timeout_s: 100}\n";
  const SuiteSummary whole = suite(runs + of_all, "whole");
  ASSERT_EQ(whole.outcomes.size(), 2u);
  EXPECT_TRUE(whole.outcomes[0].passed()) << whole.outcomes[0].error;
  EXPECT_NE(read_file(path("whole/a/config.yaml")).find("timeout_s: 100"), std::string::npos);
  EXPECT_EQ(whole.outcomes[1].problems, std::vector<std::string>{"the mapper ended with exit code 3, see b/mapper/stderr.log"});
  // Parts together are the whole, also of what failed.
  EXPECT_EQ(suite(runs + of_all, "parts", {1, 2}).missing, std::vector<std::string>{"a"});
  EXPECT_TRUE(suite(runs + of_all, "parts", {0, 2}).missing.empty());
  for (const char* name : {"suite.json", "suite.md", "junit.xml"})
    EXPECT_EQ(read_file(path("parts") / name), read_file(path("whole") / name)) << name;
}

TEST_F(OtherMapper, EndsWithTheSuiteThatIsStopped) {
  const fs::path pid = path("pid");
  SuiteHooks hooks;
  // As soon as it has said who it is.
  hooks.check = [&] {
    if (fs::exists(pid)) throw Error("stopped by a signal");
  };
  const std::string command =
      "echo {recording} {out}; echo $$ >'" + pid.string() + ".new'; mv '" + pid.string() + ".new' '" + pid.string() + "'; exec sleep 600";
  EXPECT_ERROR(suite(run_of("a", mapper(command)), "out", {}, hooks), "stopped by a signal");
  const pid_t child = std::atoi(read_file(pid).c_str());
  ASSERT_GT(child, 0);
  EXPECT_EQ(::kill(child, 0), -1);
  EXPECT_EQ(errno, ESRCH);
  for (const auto& entry : fs::directory_iterator(path("out"))) EXPECT_EQ(entry.path().filename(), "units");
}

TEST_F(OtherMapper, WhatCannotBeIsSaidBeforeTheFirstDrive) {
  const auto refused = [&](const std::string& more) { return [&, more] { suite(run_of("a", more), "out"); }; };
  const std::string call = "my_mapper {recording} {out}";
  EXPECT_ERROR(refused(mapper("my_mapper {recording}"))(), "suite.yaml", "run 'a'", "does not say {out}");
  EXPECT_ERROR(refused(mapper(call + " {boxes}"))(), "run 'a'", "truth_stages.detector");
  EXPECT_ERROR(refused(mapper(call, ", depends: [none.bin]"))(), "run 'a'", "external_mapper.depends", "'none.bin'");
  EXPECT_ERROR(refused(mapper(call, ", depends: [/dev/null]"))(), "external_mapper.depends", "'/dev/null' is neither");
  EXPECT_ERROR(refused(mapper(call, ", format: mp4"))(), "suite.yaml", "format", "tum");
  EXPECT_ERROR(refused(mapper(call) + ", profile: paper")(), "run 'a'", "paper", "another mapper");
  EXPECT_ERROR(refused(mapper(call) + ", poses: laser")(), "run 'a'", "laser", "truth");
  EXPECT_ERROR(refused(mapper(call) + ", pass: {surface_found: 0.5}")(), "run 'a'", "pass.surface_found");
  // --mapper for all runs, of which one has an earlier run's configuration.
  write_file(path("some.yaml"), "simulation: {max_frames: 1}\n");
  write_file(path("suite.yaml"), "suite: {runs: {a: {scenario: yard.yaml, config: some.yaml}}}\n");
  EXPECT_ERROR(run_suite({path("suite.yaml"), {{"external_mapper.command", "'" + call + "'"}}, path("out"), {}, false}), "run 'a'",
               "config some.yaml", "another mapper");
  EXPECT_FALSE(fs::exists(path("out/a")));
}

TEST_F(OtherMapper, HasAStudyOfItsOwn) {
  const auto heights = [&](const std::string& command, const std::string& out, const std::string& more = "") {
    return study(mapper(command, more), kHeight, out);
  };
  const auto value = [](const CandidateResult& candidate, const char* name) { return candidate.runs.at(0).values[*study_measure(name)]; };
  const StudySummary summary = run_study(heights(good(), "out"));
  ASSERT_TRUE(summary.results && summary.results->best);
  ASSERT_EQ(summary.results->candidates.size(), 2u);
  for (const CandidateResult& candidate : summary.results->candidates) {
    EXPECT_NEAR(value(candidate, "mean_iou3d").value(), 1.0, 1e-9) << candidate.runs[0].error;
    EXPECT_EQ(value(candidate, "precision"), 1.0);
    for (const char* ours : {"unlocalised_share", "surface_found", "detection_ap50", "frames_without_pose"})
      EXPECT_FALSE(value(candidate, ours)) << ours;
    EXPECT_TRUE(candidate.measured[*study_measure("route_s")]);
  }
  EXPECT_TRUE(fs::is_empty(path("out/drives")));
  EXPECT_NE(read_file(path("out/best/room.yaml")).find("truth.json"), std::string::npos) << "its command goes with the best";
  const StudySummary again = run_study(heights(good(), "out"));
  EXPECT_EQ(again.found, 2);
  EXPECT_EQ(again.found_unwatched, 2);

  // One arm fails: told with it, and tried again. Side by side they are the same.
  StudyRequest broken = heights("case {out} in *c001*) echo too low >&2; exit 4;; esac; " + good(), "broken", ", keep_recording: true");
  broken.jobs = 2;
  const StudySummary failed = run_study(broken);
  EXPECT_EQ(failed.results->candidates[0].runs.at(0).error, "");
  EXPECT_EQ(failed.results->candidates[1].broken.at(0),
            "room, seed 1: the mapper ended with exit code 4, see drives/c001-room-1/mapper/stderr.log: too low");
  EXPECT_EQ(failed.results->best, 0u);
  EXPECT_TRUE(fs::exists(path("broken/drives/c000-room-1/mapper/recording/rgb.txt")));
  EXPECT_EQ(read_file(path("broken/drives/c001-room-1/mapper/stderr.log")), "too low\n");

  StudyRequest wrong = heights("my_mapper {recording}", "wrong");
  EXPECT_ERROR(run_study(wrong), "study.yaml", "candidate c000", "does not say {out}");
  wrong = heights(good(), "wrong");
  wrong.settings = {{"study.judge.best_by", "surface_found"}};
  EXPECT_ERROR(run_study(wrong), "judge.best_by", "surface_found");
  EXPECT_FALSE(fs::exists(path("wrong/units")));
}

TEST_F(OtherMapper, OfAStudyMayBeAFactorAndKeepsLittleOfFailures) {
  const auto driven = [&](const std::string& commands) {
    return run_study(study(mapper(good()), "key: external_mapper.command, values: [" + commands + "]", "out"));
  };
  // What YAML would take for a quotation, a map and a remark.
  const std::string failing = R"("echo" {recording} {out}; echo "a: b #c" >&2; exit 3)";
  const StudySummary first = driven("'" + failing + "', 'echo {recording} {out}; exit 4'");
  ASSERT_EQ(first.results->candidates.size(), 3u);
  EXPECT_EQ(first.results->candidates[0].runs.at(0).error, "");
  EXPECT_EQ(first.results->candidates[1].values.at(0), failing);
  EXPECT_EQ(first.results->candidates[1].runs.at(0).error,
            "the mapper ended with exit code 3, see drives/c001-room-1/mapper/stderr.log: a: b #c");
  EXPECT_TRUE(fs::exists(path("out/drives/c001-room-1/mapper/recording")));
  EXPECT_FALSE(fs::exists(path("out/drives/c002-room-1/mapper/recording"))) << "only of the first that fails";
  EXPECT_TRUE(fs::exists(path("out/drives/c002-room-1/mapper/stderr.log")));
  // Another study in the same place takes away what is not its own, and nothing that no study made.
  make_folder(path("out/drives/notes"));
  driven("'" + failing + "'");
  EXPECT_TRUE(fs::exists(path("out/drives/c001-room-1")));
  EXPECT_FALSE(fs::exists(path("out/drives/c002-room-1")));
  EXPECT_TRUE(fs::exists(path("out/drives/notes")));
}

TEST_F(OtherMapper, ThatCannotBeStartedStopsTheStudy) {
  EXPECT_ERROR(run_study(study(mapper("no_such_mapper {recording} {out}"), kHeight, "out")), "study.yaml", "stopped", "exit code 127",
               "drives/c000-room-1/mapper/stderr.log", "no_such_mapper");
  EXPECT_TRUE(fs::exists(path("out/drives/c000-room-1/mapper/stderr.log")));
  EXPECT_FALSE(fs::exists(path("out/drives/c001-room-1")));
}

TEST_F(OtherMapper, SideBySideEndsWithTheCallersWords) {
  const fs::path begun = path("begun");
  StudyRequest request = study(mapper("echo {recording} {out} >>'" + begun.string() + "'; exec sleep 600"), kHeight, "out");
  request.jobs = 2;
  StudyHooks hooks;
  hooks.check = [&] {
    const std::string lines = fs::exists(begun) ? read_file(begun) : "";
    if (std::count(lines.begin(), lines.end(), '\n') == 2) throw Error("ended by the user");
  };
  EXPECT_ERROR(run_study(request, hooks), "ended by the user");
}

class OtherMappersUnit : public ::testing::Test {
 protected:
  OtherMappersUnit() { config_.external_mapper.command = "my_mapper {recording} {out}"; }
  std::string unit() const {
    Digest digest;
    add_run(config_, "hall", digest);
    return digest.hex();
  }
  test::TemporaryFolder folder_;
  RunConfig config_;
};

TEST_F(OtherMappersUnit, IsAnotherOneWithEachThingItDependsOn) {
  const fs::path file = folder_.path() / "weights.bin", set = folder_.path() / "set";
  write_file(file, "a");
  make_folder(set / "deep");
  write_file(set / "deep/part", "a");
  std::vector<std::string> units = {unit()};
  const auto expect_new = [&](const char* what) {
    EXPECT_EQ(std::count(units.begin(), units.end(), unit()), 0) << what;
    EXPECT_EQ(unit(), unit());
    units.push_back(unit());
  };
  config_.external_mapper.command += " --fast";
  expect_new("command");
  config_.external_mapper.format = "scenenn";
  expect_new("format");
  config_.external_mapper.timeout_s = 60;
  expect_new("timeout");
  config_.external_mapper.keep_recording = true;
  expect_new("keep_recording");
  config_.external_mapper.depends = {file.string()};
  expect_new("a file");
  write_file(file, "b");
  expect_new("its bytes");
  config_.external_mapper.depends = {file.string(), set.string()};
  expect_new("a folder");
  write_file(set / "deep/part", "b");
  expect_new("what is in it");
  fs::rename(set / "deep/part", set / "deep/other");
  expect_new("a name in it");
  // Where they lie does not count.
  const std::string before = unit();
  fs::rename(file, folder_.path() / "moved.bin");
  config_.external_mapper.depends[0] = (folder_.path() / "moved.bin").string();
  EXPECT_EQ(unit(), before);
}

TEST_F(OtherMappersUnit, FollowsLinksBelowAFolderThatMayLeadInACircle) {
  const fs::path set = folder_.path() / "set", store = folder_.path() / "store";
  make_folder(set / "deep");
  make_folder(store / "v1");
  make_folder(store / "v2");
  write_file(store / "v1/weights", "a");
  write_file(store / "v2/weights", "b");
  fs::create_directory_symlink(store / "v1", set / "model");
  fs::create_directory_symlink(set, set / "deep/up");
  fs::create_symlink("nowhere", set / "broken");
  config_.external_mapper.depends = {set.string()};
  const std::string before = unit();
  write_file(store / "v1/weights", "c");
  const std::string other_bytes = unit();
  EXPECT_NE(other_bytes, before);
  fs::remove(set / "model");
  fs::create_directory_symlink(store / "v2", set / "model");
  EXPECT_NE(unit(), other_bytes);
  write_file(store / "v2/weights", "a");
  EXPECT_EQ(unit(), before) << "where it leads does not count";
}

// A suite's `external_mapper` is also that of a run with `command: ""`.
TEST_F(OtherMappersUnit, OfOurOwnMapperCountsNothingOfAnother) {
  config_.external_mapper = {};
  const std::string ours = unit();
  config_.external_mapper.timeout_s = 60;
  config_.external_mapper.format = "scenenn";
  config_.external_mapper.depends = {(folder_.path() / "none.bin").string()};
  EXPECT_EQ(unit(), ours);
}

}  // namespace
}  // namespace waretwin
