// Gates: what counts as worse, and how it is said.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "harness/gate/comparison_junit.h"
#include "harness/score/score_json.h"
#include "tests/harness/score_fixtures.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

using test::object;

RunScore run_score(const std::vector<ListedObject>& mapped) {
  RunScore score;
  score.scenario = "hall";
  score.profile = "best";
  score.seed = 7;
  score.digest = "aa";
  score.objects = compare_lists(mapped, {object(1, "c", 0, 0), object(2, "c", 9, 0)});
  score.trajectory = TrajectoryScore{.pairs = 3, .ate_rmse_m = 0.01};
  score.timing_ms["frame"] = {20.0, 30.0, 40.0};
  return score;
}

JudgedScore judged(const RunScore& score) { return judged_score(score_json(score), "score.json"); }
JudgedScore two_found() { return judged(run_score({object(5, "c", 0, 0), object(6, "c", 9, 0)})); }

std::optional<double> value_of(const JudgedScore& score, const std::string& name) {
  for (std::size_t i = 0; i < measures().size(); ++i) {
    if (name == measures()[i].name) return score.values[i];
  }
  ADD_FAILURE() << "no measure " << name;
  return std::nullopt;
}

void set_value(JudgedScore& score, const std::string& name, std::optional<double> value) {
  for (std::size_t i = 0; i < measures().size(); ++i) {
    if (name == measures()[i].name) score.values[i] = value;
  }
}

Verdict verdict_of(const Comparison& comparison, const std::string& name) {
  for (const ComparedValue& value : comparison.values) {
    if (value.name == name) return value.verdict;
  }
  ADD_FAILURE() << "nothing said of " << name;
  return Verdict::kNotJudged;
}

TEST(Gate, ReadsWhatScoreJsonSays) {
  RunScore score = run_score({object(5, "c", 0, 0)});
  score.motion = MotionReport{};
  score.motion->contacts.resize(3);
  score.frames_without_pose = 4;
  score.peak_rss_mb = 512.0;
  score.surface = SurfaceScore{.mean_m = 0.003, .found = 0.75};
  const JudgedScore read = judged(score);
  EXPECT_EQ(read.scenario, "hall");
  EXPECT_EQ(read.seed, 7);
  EXPECT_EQ(value_of(read, "recall"), 0.5);
  EXPECT_EQ(value_of(read, "precision"), 1.0);
  EXPECT_EQ(value_of(read, "mean_iou3d"), 0.5);
  EXPECT_EQ(value_of(read, "ate_rmse_m"), 0.01);
  EXPECT_EQ(value_of(read, "surface_found"), 0.75);
  EXPECT_EQ(value_of(read, "surface_mean_m"), 0.003);
  EXPECT_EQ(value_of(read, "contacts"), 3.0);
  EXPECT_EQ(value_of(read, "frames_without_pose"), 4.0);
  EXPECT_EQ(value_of(read, "frame_median_ms"), 20.0);
  EXPECT_EQ(value_of(read, "frame_p95_ms"), 30.0);
  EXPECT_EQ(value_of(read, "peak_rss_mb"), 512.0);
  EXPECT_EQ(value_of(read, "detection_ap50"), std::nullopt);
  ASSERT_EQ(read.objects.size(), 2u);
  EXPECT_EQ(read.objects[1].iou3d, 0.0);
}

// A measure whose place in score.json is misspelt would never be judged.
TEST(Gate, EveryMeasureStandsInScoreJson) {
  RunScore score = run_score({object(5, "c", 0, 0)});
  score.motion = MotionReport{};
  score.surface = SurfaceScore{};
  score.detection = DetectionScore{};
  const auto json = nlohmann::json::parse(score_json(score));
  for (const Measure& measure : measures()) EXPECT_TRUE(json.contains(nlohmann::json::json_pointer(measure.place))) << measure.place;
}

TEST(Gate, TheSameScoreIsNotWorse) {
  const Comparison comparison = compare_scores(two_found(), two_found(), {});
  EXPECT_FALSE(comparison.worse());
  EXPECT_TRUE(comparison.same_map);
  EXPECT_TRUE(comparison.notes.empty());
  EXPECT_EQ(verdict_of(comparison, "recall"), Verdict::kSame);
  EXPECT_EQ(verdict_of(comparison, "frame_median_ms"), Verdict::kNotJudged);
}

TEST(Gate, AToleranceIsTheLastThatIsAllowed) {
  Tolerances tolerances;
  for (const auto& [name, gain] : std::vector<std::pair<std::string, double>>{{"mean_iou3d", 1.0}, {"ate_rmse_m", -1.0}}) {
    JudgedScore before = two_found(), after = before;
    set_value(before, name, 0.5);
    double tolerance = 0.0;
    for (std::size_t i = 0; i < measures().size(); ++i) {
      if (name == measures()[i].name) tolerance = *tolerances.measures.values[i];
    }
    const auto verdict = [&](double steps) {
      set_value(after, name, 0.5 + gain * steps * tolerance);
      return verdict_of(compare_scores(before, after, tolerances), name);
    };
    EXPECT_EQ(verdict(-1.01), Verdict::kWorse) << name;
    EXPECT_EQ(verdict(-1.0), Verdict::kSame) << name;
    EXPECT_EQ(verdict(1.0), Verdict::kSame) << name;
    EXPECT_EQ(verdict(1.01), Verdict::kBetter) << name;
  }
}

TEST(Gate, ALostObjectIsWorse) {
  const Comparison comparison = compare_scores(two_found(), judged(run_score({object(5, "c", 0, 0)})), {});
  EXPECT_TRUE(comparison.worse());
  EXPECT_EQ(verdict_of(comparison, "recall"), Verdict::kWorse);
  ASSERT_EQ(comparison.objects.size(), 1u);
  EXPECT_EQ(comparison.objects[0].name, "object 2 (c)");
  EXPECT_EQ(comparison.objects[0].verdict, Verdict::kWorse);
}

// One object gains what another loses: the mean says nothing.
TEST(Gate, EachObjectIsJudgedByItself) {
  JudgedScore before = two_found(), after = before;
  before.objects[0].iou3d = after.objects[1].iou3d = 0.9;
  before.objects[1].iou3d = after.objects[0].iou3d = 0.8;
  EXPECT_TRUE(compare_scores(before, after, {}).worse());
  before.objects[0].counted = false;
  const Comparison other = compare_scores(before, after, {});
  EXPECT_FALSE(other.worse());
  EXPECT_EQ(other.notes.size(), 1u);
  // Fewer objects that count: fewer were seen.
  JudgedScore fewer = before;
  set_value(before, "objects_seen", 2.0);
  set_value(fewer, "objects_seen", 1.0);
  EXPECT_TRUE(compare_scores(before, fewer, {}).worse());
}

TEST(Gate, WhatIsGoneIsWorseAndWhatIsNewIsNot) {
  JudgedScore with = two_found(), without = with;
  set_value(without, "ate_rmse_m", std::nullopt);
  EXPECT_EQ(verdict_of(compare_scores(with, without, {}), "ate_rmse_m"), Verdict::kWorse);
  EXPECT_EQ(verdict_of(compare_scores(without, with, {}), "ate_rmse_m"), Verdict::kNotJudged);
}

// Whoever has no surface and no detector of ours has lost none.
TEST(Gate, AnotherMapperIsNotJudgedByOurStages) {
  const std::string rest = R"("schema": 1, "summary": {"recall": 1.0}, "frames": {"without_pose": 0})";
  const JudgedScore ours = judged_score("{\"profile\": \"best\", \"surface\": {\"found\": 0.9}, " + rest + "}", "ours.json");
  const JudgedScore theirs = judged_score("{\"profile\": \"mapper\", " + rest + "}", "theirs.json");
  const auto values_of = [](const JudgedScore& score) {
    return std::count_if(score.values.begin(), score.values.end(), [](const auto& value) { return value.has_value(); });
  };
  EXPECT_EQ(values_of(ours), 3);
  EXPECT_EQ(values_of(theirs), 1) << "nobody asked it for its poses";
  EXPECT_FALSE(compare_scores(ours, theirs, Tolerances()).worse());
  // A trajectory is theirs to leave or not; one that they left once is expected again.
  JudgedScore with = ours, left = theirs;
  set_value(with, "ate_rmse_m", 0.01);
  set_value(left, "ate_rmse_m", 0.01);
  EXPECT_EQ(verdict_of(compare_scores(with, theirs, {}), "ate_rmse_m"), Verdict::kNotJudged);
  EXPECT_EQ(verdict_of(compare_scores(left, theirs, {}), "ate_rmse_m"), Verdict::kWorse);
  const JudgedScore lost = judged_score(R"({"schema": 1, "profile": "mapper", "summary": {"recall": 0.5}})", "lost.json");
  EXPECT_TRUE(compare_scores(ours, lost, Tolerances()).worse());
}

TEST(Gate, TimesAreJudgedWhereTheyHaveATolerance) {
  JudgedScore before = two_found(), after = before;
  set_value(after, "frame_median_ms", 100.0);
  EXPECT_FALSE(compare_scores(before, after, {}).worse());
  Tolerances tolerances;
  read_config_text("tolerances: {frame_median_ms: 50, recall: null}", "t.yaml", [&](Fields& f) { f.group("tolerances", tolerances, ""); });
  EXPECT_EQ(verdict_of(compare_scores(before, after, tolerances), "frame_median_ms"), Verdict::kWorse);
  set_value(after, "recall", 0.0);
  EXPECT_EQ(verdict_of(compare_scores(before, after, tolerances), "recall"), Verdict::kNotJudged);
  EXPECT_EQ(verdict_of(compare_scores(before, after, tolerances), "precision"), Verdict::kSame);  // keeps its usual tolerance
}

TEST(Gate, SaysWhatElseDiffers) {
  JudgedScore before = two_found(), after = before;
  after.seed = 8;
  after.profile = "paper";
  after.digest = "bb";
  const Comparison comparison = compare_scores(before, after, {});
  EXPECT_FALSE(comparison.same_map);
  const std::string text = comparison_text(comparison);
  EXPECT_NE(text.find("seed: 7 before, 8 after"), std::string::npos);
  EXPECT_NE(text.find("profile: best before, paper after"), std::string::npos);
  EXPECT_EQ(text.find("the same to the last bit"), std::string::npos);
}

TEST(Gate, TheTableIsMarkdownWithEqualColumns) {
  const std::string text = comparison_text(compare_scores(two_found(), judged(run_score({object(5, "c", 0, 0)})), {}));
  std::istringstream lines(text);
  std::string line, first;
  std::getline(lines, first);
  EXPECT_EQ(std::count(first.begin(), first.end(), '|'), 7);
  while (std::getline(lines, line) && !line.empty()) {
    EXPECT_EQ(line.size(), first.size()) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '|'), 7) << line;
  }
  EXPECT_NE(text.find("| recall "), std::string::npos);
  EXPECT_NE(text.find("-0.5000"), std::string::npos);
  EXPECT_NE(text.find("**worse**"), std::string::npos);
}

TEST(Gate, PassMarksAreReachedOrNamed) {
  PassMarks marks;
  read_config_text("pass: {recall: 0.9, ate_rmse_m: 0.01, detection_ap50: 0.5}", "s.yaml", [&](Fields& f) { f.group("pass", marks, ""); });
  const std::vector<MissedMark> missed = missed_marks(judged(run_score({object(5, "c", 0, 0)})), marks);
  ASSERT_EQ(missed.size(), 2u);
  EXPECT_EQ(missed_text({"recall", 0.99996, 1.0, true}), "recall 0.999960, expected at least 1");
  EXPECT_EQ(missed_text(missed[0]), "recall 0.5, expected at least 0.9");
  EXPECT_EQ(missed_text(missed[1]), "detection_ap50 has no value, expected at least 0.5");
  JudgedScore far = two_found();
  set_value(far, "ate_rmse_m", 0.02);
  EXPECT_EQ(missed_text(missed_marks(far, marks).at(0)), "ate_rmse_m 0.02, expected at most 0.01");
}

TEST(Gate, WrongFilesAreRefusedInOneLine) {
  EXPECT_ERROR(judged_score("{", "a.json"), "a.json", "is not JSON");
  EXPECT_ERROR(judged_score("[]", "a.json"), "a.json", "schema", "expected a score.json");
  EXPECT_ERROR(judged_score(R"({"schema": 9})", "a.json"), "schema is 9", "expected 1");
  EXPECT_ERROR(judged_score(R"({"schema": 1, "summary": {"recall": "high"}})", "a.json"), "summary/recall", "\"high\"",
               "expected a number");
  EXPECT_ERROR(judged_score(R"({"schema": 1, "suite": "smoke", "runs": []})", "a.json"), "no measure", "expected a score.json");
  EXPECT_ERROR(judged_score(R"({"schema": 1, "objects": {}})", "a.json"), "objects is {}", "expected a list");
  EXPECT_ERROR(judged_score(R"({"schema": 1, "motion": {"contacts": 3}})", "a.json"), "motion/contacts is 3", "expected a list");
  EXPECT_ERROR(judged_score(R"({"schema": 1, "objects": [3]})", "a.json"), "objects", "3", "expected truth_id, class and iou3d");
  EXPECT_ERROR(read_judged_score("/nowhere/score.json"), "/nowhere/score.json", "does not exist");
}

TEST(Junit, CountsAndEscapes) {
  const std::string xml = junit_xml(
      {{"a<b", {{"c", "fine", 1.5, "", ""}, {"c", "\"x\" & y", {}, "1 < 2\nsecond\x01", ""}, {"c", "broken", {}, "", "no such file"}}}});
  EXPECT_NE(xml.find(R"(<testsuite name="a&lt;b" tests="3" failures="1" errors="1" time="1.500">)"), std::string::npos);
  EXPECT_NE(xml.find(R"(<testcase classname="c" name="fine" time="1.500"/>)"), std::string::npos);
  EXPECT_NE(xml.find(R"(name="&quot;x&quot; &amp; y")"), std::string::npos);
  EXPECT_NE(xml.find(R"(<failure message="1 &lt; 2">1 &lt; 2&#10;second?</failure>)"), std::string::npos);
  EXPECT_NE(xml.find(R"(<error message="no such file">no such file</error>)"), std::string::npos);
}

TEST(Junit, HasACaseForEveryJudgedMeasure) {
  const Comparison comparison = compare_scores(two_found(), judged(run_score({object(5, "c", 0, 0)})), {});
  const JunitSuite suite = junit_of(comparison, "hall");
  std::vector<std::string> all, failed;
  for (const JunitCase& one : suite.cases) {
    all.push_back(one.name);
    if (!one.failure.empty()) failed.push_back(one.name);
  }
  EXPECT_EQ(all, (std::vector<std::string>{"objects_seen", "recall", "precision", "mean_iou3d", "mean_e_trans_m", "mean_e_rot_deg", "ap50",
                                           "map_paper", "ate_rmse_m", "ate_max_m", "rpe_trans_m", "rpe_rot_deg", "frames_without_pose",
                                           "object 2 (c)"}));
  EXPECT_EQ(failed, (std::vector<std::string>{"recall", "mean_iou3d", "ap50", "object 2 (c)"}));
  EXPECT_EQ(suite.cases[1].failure, "recall was 1.0000, is 0.5000, may get worse by 0");
}

}  // namespace
}  // namespace waretwin
