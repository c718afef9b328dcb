// Suites: every run by itself, once, wherever it is driven.
#include "harness/suite/suite.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/files.h"
#include "harness/suite/suite_text.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

// A second or less: a bare room, true boxes and poses, a few frames.
std::string quick(const std::string& more, int seed = 3) {
  return "{generate: {style: flat, seed: " + std::to_string(seed) +
         ", coverage: 0}, detector: truth, poses: truth, depth: truth, frames: 4" + more + "}\n";
}

std::string three_runs() {
  const std::string bare = ", set: [extras.surface=false, extras.pictures=false]";
  return "suite:\n  name: small\n  runs:\n    a: " + quick(bare + ", pass: {contacts: 0, ate_rmse_m: 0.001}") + "    b: " + quick(bare, 4) +
         "    c: " + quick(bare, 5);
}

class Suite : public ::testing::Test {
 protected:
  SuiteSummary run(const std::string& yaml, const std::string& out, Shard shard = {}, bool merge_only = false) {
    const fs::path file = folder_.path() / "suite.yaml";
    write_file(file, yaml);
    return run_suite({file, settings_, folder_.path() / out, shard, merge_only});
  }
  fs::path file(const std::string& name) const { return folder_.path() / name; }

  test::TemporaryFolder folder_;
  std::vector<Setting> settings_;
};

TEST_F(Suite, MarksAreReachedOrSaid) {
  const SuiteSummary summary = run(
      "suite:\n  runs:\n    good: " + quick(", pass: {ate_rmse_m: 0.001, contacts: 0}") +
          "    bad: " + quick(", pass: {recall: 1, surface_found: 1}") +
          "    broken: " + "{generate: {style: flat, seed: 3, coverage: 0}, detector: truth, frames: 4, set: [mapper.poses=recorded]}\n",
      "out");
  ASSERT_EQ(summary.outcomes.size(), 3u);
  const SuiteOutcome &bad = summary.outcomes[0], &broken = summary.outcomes[1], &good = summary.outcomes[2];
  EXPECT_TRUE(good.passed());
  EXPECT_EQ(good.digest.size(), 16u);
  EXPECT_FALSE(bad.passed());
  EXPECT_TRUE(std::any_of(bad.problems.begin(), bad.problems.end(), [](const std::string& problem) {
    return problem.starts_with("surface_found 0.") && problem.ends_with("expected at least 1");
  }));
  EXPECT_NE(broken.error.find("poses 'recorded'"), std::string::npos) << broken.error;
  EXPECT_TRUE(fs::exists(file("out/good/score.json")));
  EXPECT_TRUE(fs::exists(file("out/good/report.html")));
  const std::string xml = read_file(file("out/junit.xml"));
  EXPECT_NE(xml.find(R"(tests="3" failures="1" errors="1")"), std::string::npos) << xml;
  const std::string table = read_file(file("out/suite.md"));
  EXPECT_NE(table.find("- bad: surface_found"), std::string::npos);
  EXPECT_NE(table.find("**not run**"), std::string::npos);
}

TEST_F(Suite, AScoreIsHeldAgainstItsBaseline) {
  const std::string yaml = "suite:\n  runs:\n    a: " + quick(", baseline: before.json") + "  tolerances: {surface_found: 0.1}\n";
  write_file(file("before.json"), R"({"schema": 1, "surface": {"found": 0.01, "mean_m": 1.0}, "digest": "x"})");
  EXPECT_TRUE(run(yaml, "out").outcomes.at(0).passed());
  write_file(file("before.json"), R"({"schema": 1, "summary": {"recall": 1.0}, "surface": {"found": 1.0, "mean_m": 1.0}})");
  const SuiteSummary second = run(yaml, "out");
  EXPECT_EQ(second.found, 0);  // another baseline is another question
  ASSERT_EQ(second.outcomes.at(0).problems.size(), 1u);
  EXPECT_EQ(second.outcomes[0].problems[0], "recall was 1.0000 and has no value now");
}

TEST_F(Suite, ShardsTogetherAreTheWhole) {
  const SuiteSummary whole = run(three_runs(), "whole");
  EXPECT_EQ(whole.outcomes.size(), 3u);
  EXPECT_EQ(run(three_runs(), "parts", {1, 2}).missing.size(), 2u);
  EXPECT_FALSE(fs::exists(file("parts/suite.json")));
  EXPECT_EQ(run(three_runs(), "parts", {}, true).missing.size(), 2u);
  const SuiteSummary last = run(three_runs(), "parts", {0, 2});
  EXPECT_TRUE(last.missing.empty());
  for (const char* name : {"suite.json", "suite.md", "junit.xml"})
    EXPECT_EQ(read_file(file(std::string("parts/") + name)), read_file(file(std::string("whole/") + name))) << name;
}

TEST_F(Suite, WhatIsDoneIsNotDrivenAgain) {
  run(three_runs(), "out");
  const fs::path kept = file("out/a/score.json"), lost = file("out/b/score.json");
  const auto before = fs::last_write_time(kept);
  // As if it had been killed in the second run.
  for (const fs::directory_entry& entry : fs::directory_iterator(file("out/units"))) {
    if (read_file(entry.path()).find("\"run\": \"b\"") != std::string::npos) fs::remove(entry.path());
  }
  fs::remove(lost);
  const SuiteSummary again = run(three_runs(), "out");
  EXPECT_EQ(again.found, 2);
  EXPECT_EQ(fs::last_write_time(kept), before);
  EXPECT_TRUE(fs::exists(lost));
  // Another configuration is another run.
  settings_.push_back({"simulation.max_frames", "3"});
  EXPECT_EQ(run(three_runs(), "out").found, 0);
}

TEST_F(Suite, AStoppedRunIsNoResult) {
  write_file(file("suite.yaml"), three_runs());
  const SuiteRequest request{file("suite.yaml"), {}, file("out"), {}, false};
  SuiteHooks hooks;
  hooks.progress = [](const SuiteProgress& now) {
    if (now.run == "b") throw Error("stopped by a signal");
  };
  EXPECT_ERROR(run_suite(request, hooks), "stopped by a signal");
  EXPECT_EQ(run_suite(request).found, 1);
}

TEST_F(Suite, AnotherDetectorIsAnotherRun) {
  const std::string yaml = "suite:\n  runs:\n    a: {generate: {style: flat, seed: 3, coverage: 0}, detector: boxes.json, frames: 2}\n";
  write_file(file("boxes.json"), R"({"frames": []})");
  EXPECT_TRUE(run(yaml, "out").outcomes.at(0).error.empty());
  EXPECT_EQ(run(yaml, "out").found, 1);
  write_file(file("boxes.json"), R"({ "frames": []})");
  EXPECT_EQ(run(yaml, "out").found, 0);
}

TEST_F(Suite, BadSuitesAreRefusedBeforeTheFirstDrive) {
  EXPECT_ERROR(run("suite: {runs: {}}", "out"), "suite.yaml", "suite.runs is empty");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: {profile: best}\n", "out"), "suite.yaml", "scenario", "missing");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: {scenario: s.yaml, generate: {style: flat}}\n", "out"), "expected one of them");
  EXPECT_ERROR(run("suite:\n  runs:\n    a/b: " + quick(""), "out"), "'a/b'", "expected a name");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: " + quick(", pass: {recal: 1}"), "out"), "recal", "recall");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: " + quick("") + "    b: {scenario: none.yaml}\n", "out"), "suite.yaml", "run 'b'", "none.yaml");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: " + quick(", set: [sensors.cameras.camera.rate=1]"), "out"), "run 'a'",
               "sensors.cameras.camera.rate");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: " + quick(", baseline: none.json"), "out"), "run 'a'", "none.json");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: {generate: {style: flat, coverage: 0}, detector: none.json}\n", "out"), "run 'a'", "none.json");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: " + quick(", config: c.yaml"), "out"), "config", "expected none of them");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: {scenario: s.yaml, generate: {seed: 3}}\n", "out"), "generate", "no style");
  EXPECT_ERROR(run("suite:\n  runs:\n    units: " + quick(""), "out"), "'units'", "expected a name");
  EXPECT_ERROR(run("suite:\n  runs:\n    a: " + quick(", pass: {peak_rss_mb: 100}"), "out"), "peak_rss_mb");
  EXPECT_FALSE(fs::exists(file("out/a/score.json")));
}

TEST(SuiteText, AnOutcomeComesBackAsItWas) {
  SuiteOutcome outcome{"a", "", "00ff", "cpu", {"recall 0.5, expected at least 1"}, std::vector<std::optional<double>>(measures().size())};
  outcome.values[0] = 1.0 / 3.0;
  const SuiteOutcome back = read_outcome(outcome_json(outcome), "x.json");
  EXPECT_EQ(back.run, outcome.run);
  EXPECT_EQ(back.problems, outcome.problems);
  EXPECT_EQ(back.values, outcome.values);
  EXPECT_ERROR(read_outcome("{}", "x.json"), "x.json", "no result of a suite's run");
}

TEST(Shards, AreReadFromText) {
  EXPECT_EQ(parse_shard("1/3").index, 1);
  EXPECT_EQ(parse_shard("1/3").count, 3);
  for (const char* text : {"3/3", "-1/3", "1", "1/0", "a/b", "1/3x", ""}) EXPECT_ERROR(parse_shard(text), "--shard", "expected I/N");
}

}  // namespace
}  // namespace waretwin
