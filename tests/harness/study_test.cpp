// A whole study: once, in parts, and again.
#include "harness/study/study.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "harness/report/study_page.h"
#include "harness/run/closed_loop.h"
#include "harness/study/preview.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

// Some seconds: a bare room, true boxes and poses, a few frames.
std::string small(const std::string& more = "") {
  return "study:\n"
         "  name: small\n"
         "  halls: {room: {generate: {style: flat, seed: 3, coverage: 0}}}\n"
         "  seeds: [1, 2]\n"
         "  run: {detector: truth, poses: truth, depth: truth, frames: 3, set: [simulation.colour=false]}\n"
         "  vary:\n"
         "    height: {key: sensors.cameras.camera.mount.z_m, values: [1.0, 1.8]}\n"
         "    pitch: {key: sensors.cameras.camera.mount.pitch_deg, values: [30, 45]}\n"
         "  constraints: [height < 1.6]\n"
         "  coverage: {floor_spacing_m: 0.2, points_per_object: 200, place_spacing_m: 1}\n" +
         more;
}

class Study : public ::testing::Test {
 protected:
  StudyRequest request(const std::string& yaml, const std::string& out) const {
    write_file(path("study.yaml"), yaml);
    StudyRequest request;
    request.file = path("study.yaml");
    request.out = path(out);
    return request;
  }
  StudySummary run(const std::string& yaml, const std::string& out) const { return run_study(request(yaml, out)); }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  std::string results(const std::string& out) const { return read_file(path(out) / "results.json"); }

  test::TemporaryFolder folder_;
};

TEST_F(Study, LeavesTablesPlotsAndMaps) {
  const StudySummary summary = run(small(), "out");
  ASSERT_TRUE(summary.results);
  const auto& candidates = summary.results->candidates;
  ASSERT_EQ(candidates.size(), 5u);  // the baseline and four
  EXPECT_EQ(summary.runs, 6);        // two of them are too high
  EXPECT_EQ(candidates[0].values, (DesignPoint{"1.4", "45"}));
  EXPECT_EQ(candidates[3].state, CandidateState::kRefused);
  EXPECT_EQ(candidates[1].runs.size(), 2u);
  EXPECT_NE(candidates[1].runs[0].digest, candidates[2].runs[0].digest);
  const auto json = nlohmann::json::parse(results("out"));
  EXPECT_EQ(json.at("schema"), "waretwin-study-1");
  EXPECT_EQ(json.at("candidates").size(), 5u);
  EXPECT_EQ(json.at("candidates")[1].at("settings")[0], "sensors.cameras.camera.mount.z_m=1");
  EXPECT_EQ(json.at("candidates")[3].at("state"), "refused");
  EXPECT_EQ(json.at("candidates")[3].at("broken")[0], "height < 1.6 does not hold: 1.8");
  EXPECT_TRUE(json.at("candidates")[1].at("measures").at("floor_coverage").contains("difference"));
  EXPECT_EQ(results("out").find("wall"), std::string::npos);  // no times
  for (const char* name : {"results.csv", "runs.csv", "study.md", "timing.csv", "coverage/c000-room.png"})
    EXPECT_TRUE(fs::exists(path("out") / name)) << name;
  const PageData page = study_page(path("out"));
  EXPECT_FALSE(page.json["study"]["candidates"][0]["coverage"].empty());
  EXPECT_EQ(page.json["files"].size(), 5u);
  EXPECT_TRUE(fs::exists(path("out/report.html")));
  const std::string csv = read_file(path("out/results.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  const std::string head = csv.substr(0, csv.find('\n')), row = csv.substr(csv.find('\n') + 1, csv.find('\n', csv.find('\n') + 1));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(row.begin(), row.begin() + static_cast<long>(row.find('\n')), ','));
}

TEST_F(Study, PartsTogetherAreTheWhole) {
  run(small(), "whole");
  StudyRequest part = request(small(), "parts");
  part.shard = {0, 2};
  const StudySummary first = run_study(part);
  EXPECT_FALSE(first.results);
  EXPECT_EQ(first.missing, 3);
  EXPECT_FALSE(fs::exists(path("parts/results.json")));
  StudyRequest merge = request(small(), "parts");
  merge.merge_only = true;
  EXPECT_EQ(run_study(merge).missing, 3);
  part.shard = {1, 2};
  EXPECT_TRUE(run_study(part).results);
  EXPECT_EQ(results("parts"), results("whole"));
  fs::remove(path("parts/results.json"));
  EXPECT_TRUE(run_study(merge).results);
  EXPECT_EQ(results("parts"), results("whole"));
  for (const char* name : {"results.csv", "runs.csv", "study.md", "coverage/c001-room.png", "plots/effects-floor_coverage.png"})
    EXPECT_EQ(read_file(path("parts") / name), read_file(path("whole") / name)) << name;
}

TEST_F(Study, WhatIsDoneIsNotDoneAgain) {
  run(small(), "out");
  EXPECT_EQ(run(small(), "out").found, 6);
  // A wish more: what is there already is taken, the rest is driven.
  StudyRequest more = request(small(), "out");
  more.settings = {{"study.seeds", "[1, 2, 3]"}};
  const StudySummary summary = run_study(more);
  EXPECT_EQ(summary.runs, 9);
  EXPECT_EQ(summary.found, 6);
  // A damaged unit is named, not taken.
  for (const auto& entry : fs::directory_iterator(path("out/units"))) write_file(entry.path(), "{\"digest\": \"");
  EXPECT_ERROR(run(small(), "out"), "units", "is no unit of a study");
}

TEST_F(Study, AStopLosesNothingThatWasDone) {
  StudyRequest stopped = request(small(), "out");
  stopped.jobs = 1;
  int drives = 0;
  StudyHooks hooks;
  std::string last;
  hooks.progress = [&](const StudyProgress& now) {
    if (now.stage != "runs" || now.what == last) return;
    last = now.what;
    if (++drives == 3) throw Error("stopped");
  };
  EXPECT_ERROR(run_study(stopped, hooks), "stopped");
  EXPECT_FALSE(fs::exists(path("out/results.json")));
  const StudySummary again = run(small(), "out");
  EXPECT_EQ(again.found, 2);
  run(small(), "whole");
  EXPECT_EQ(results("out"), results("whole"));
}

TEST_F(Study, DrivesSideBySideMakeTheSameBytes) {
  StudyRequest one = request(small(), "one"), many = request(small(), "many");
  one.jobs = 1;
  many.jobs = 3;
  run_study(one);
  run_study(many);
  EXPECT_EQ(results("one"), results("many"));
  // A stop is heard by all of them.
  StudyRequest stopped = request(small(), "stopped");
  stopped.jobs = 3;
  StudyHooks hooks;
  hooks.progress = [](const StudyProgress& now) {
    if (now.stage == "runs" && now.share > 0.4) throw Error("stopped");
  };
  EXPECT_ERROR(run_study(stopped, hooks), "stopped");
  EXPECT_FALSE(fs::exists(path("stopped/results.json")));
  run_study(request(small(), "stopped"));
  EXPECT_EQ(results("one"), results("stopped"));
}

TEST_F(Study, ScreeningMapsTheBestByCoverageAlone) {
  const StudySummary summary = run(small("  screen: {keep: 1, by: floor_coverage}\n"), "out");
  ASSERT_TRUE(summary.results);
  const auto& candidates = summary.results->candidates;
  const std::size_t floor = *study_measure("floor_coverage");
  const std::size_t better = candidates[1].measured[floor]->mean > candidates[2].measured[floor]->mean ? 1 : 2;
  EXPECT_EQ(candidates[better].state, CandidateState::kMapped);
  EXPECT_EQ(candidates[3 - better].state, CandidateState::kScreenedOut);
  EXPECT_EQ(candidates[0].state, CandidateState::kMapped);
  EXPECT_EQ(summary.runs, 4);
  EXPECT_FALSE(candidates[3 - better].measured[*study_measure("precision")]);
}

TEST_F(Study, WhatDiffersInTheMapperAloneSeesTheSame) {
  StudyRequest rates = request(small(), "out");
  rates.settings = {{"study.vary.pitch.key", "mapper.integrate.voxel_m"}, {"study.vary.pitch.values", "[0.02, 0.03, 0.05, 0.08]"}};
  rates.coverage_only = true;
  const StudySummary summary = run_study(rates);
  ASSERT_TRUE(summary.results);
  const std::size_t floor = *study_measure("floor_coverage");
  const auto& candidates = summary.results->candidates;
  ASSERT_EQ(candidates.size(), 9u);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_EQ(candidates[i].measured[floor]->mean, candidates[1].measured[floor]->mean);
  std::size_t units = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(path("out/units"))) ++units;
  EXPECT_EQ(units, 2u);  // the baseline's and that of the one height that is not refused
}

TEST_F(Study, WhatIsViewableIsTheSameForRobotsOfAllSizes) {
  StudyRequest sizes = request(small(), "out");
  sizes.settings = {{"study.vary.pitch.key", "robot.width_m"}, {"study.vary.pitch.values", "[0.3, 0.6, 1.5]"}};
  sizes.coverage_only = true;
  StudyRequest part = sizes;
  part.out = path("parts");
  part.shard = {1, 2};
  run_study(sizes);
  run_study(part);  // another candidate comes first
  EXPECT_EQ(read_file(path("out/screening/results.json")), read_file(path("parts/screening/results.json")));
}

TEST_F(Study, TheBaselineIsNotDrivenTwice) {
  // 1.40 is 1.4; but where another key goes along it is another candidate.
  StudyRequest again = request(small(), "out");
  again.settings = {{"study.vary.height.values", "[1.40]"}, {"study.vary.pitch.values", "[45.0]"}};
  again.coverage_only = true;
  EXPECT_EQ(run_study(again).results->candidates.size(), 1u);
  again.settings.push_back({"study.vary.pitch.also", "[sensors.cameras.camera.mount.roll_deg]"});
  EXPECT_EQ(run_study(again).results->candidates.size(), 2u);
}

TEST_F(Study, WhatIsThereOutlivesWhatCannotBeDone) {
  run(small(), "out");
  const std::string before = results("out");
  StudyRequest merge = request(small(), "out");
  merge.merge_only = true;
  merge.settings = {{"study.seeds", "[1, 2, 3]"}};
  EXPECT_FALSE(run_study(merge).results);
  StudyRequest look = request(small(), "out");
  look.coverage_only = true;
  run_study(look);
  EXPECT_EQ(results("out"), before);
}

TEST_F(Study, TheBestCanBeDrivenAgain) {
  const StudySummary summary = run(small(), "out");
  ASSERT_TRUE(summary.results && summary.results->best);
  const CandidateResult& best = summary.results->candidates[*summary.results->best];
  fs::path hall;
  for (const auto& entry : fs::directory_iterator(path("out/halls"))) hall = entry.path();
  const RunConfig config = load_run_config(hall / "scenario.yaml", RunConfig(), path("out/best/room.yaml"), {});
  EXPECT_EQ(config.scenario.seed, 1u);
  EXPECT_TRUE(config.extras.pictures);
  const auto scene = std::make_shared<const Scene>(build_scene(config.scenario));
  EXPECT_EQ(run_closed_loop(config, scene).score.digest, best.runs.at(0).digest);
}

TEST_F(Study, CoverageAloneMapsNothing) {
  StudyRequest look = request(small(), "out");
  look.coverage_only = true;
  const StudySummary summary = run_study(look);
  ASSERT_TRUE(summary.results && summary.results->best);
  EXPECT_EQ(summary.runs, 0);
  EXPECT_EQ(summary.results->best_by, "object_coverage");
  EXPECT_EQ(summary.folder, path("out/screening"));
  EXPECT_TRUE(fs::exists(path("out/screening/plots/pareto.png")));
}

TEST_F(Study, ADriveThatCannotBeStandsWithItsCandidate) {
  const StudySummary summary = run(small("  judge: {confidence: 0.9}\n"), "out");
  EXPECT_TRUE(summary.results->candidates[1].feasible());
  StudyRequest without = request(small(), "broken");
  without.settings = {{"mapper.poses", "recorded"}, {"truth_stages.poses", "false"}};
  const StudySummary broken = run_study(without);
  ASSERT_TRUE(broken.results);
  EXPECT_FALSE(broken.results->best);
  EXPECT_NE(broken.results->candidates[1].broken.at(0).find("room, seed 1: "), std::string::npos);
  EXPECT_EQ(run_study(without).found, 0);  // it may have been the disk
}

TEST_F(Study, WhatIsWrongIsSaidBeforeAnythingIsDriven) {
  EXPECT_ERROR(run(small("  vehicle: none.yaml\n"), "out"), "none.yaml");
  EXPECT_ERROR(run("study:\n  halls: {a: {scenario: none.yaml}}\n  vary: {h: {key: mapper.rate_hz, values: [1]}}\n", "out"), "study.yaml",
               "none.yaml");
  StudyRequest wrong = request(small(), "out");
  wrong.settings = {{"study.vary.height.key", "sensors.cameras.camera.mount.zm"}};
  EXPECT_ERROR(run_study(wrong), "study.yaml", "vary.height.key", "zm");
  wrong.settings = {{"study.vary.pitch.values", "[30, steep]"}};
  EXPECT_ERROR(run_study(wrong), "candidate c00", "steep");
  wrong.settings = {{"study.vary.pitch.key", "sensors.cameras.camera.mount.z_m"}};
  EXPECT_ERROR(run_study(wrong), "varies already");
  wrong.settings = {{"sensors.cameras.camera.mount.z_m", "1"}};
  EXPECT_ERROR(run_study(wrong), "varies in this study");
  wrong.settings = {{"seed", "1"}};
  EXPECT_ERROR(run_study(wrong), "expected --seed");
  wrong.settings = {{"study.colour", "1"}};
  EXPECT_ERROR(run_study(wrong), "study.colour");
  EXPECT_FALSE(fs::exists(path("out/units")));
}

TEST_F(Study, PreviewsShowEachCandidate) {
  EXPECT_EQ(draw_previews(request(small(), "out")), 3);
  EXPECT_TRUE(fs::exists(path("out/preview.png")));
  EXPECT_TRUE(fs::exists(path("out/preview/c002.png")));
  EXPECT_FALSE(fs::exists(path("out/preview/c003.png")));
}

TEST_F(Study, SeveralCamerasAndTheVehicleItself) {
  write_file(
      path("vehicle.yaml"),
      "sensors:\n  cameras:\n    rear: {preset: azure_kinect, rate_hz: 5, mount: {x_m: -0.3, z_m: 1.2, yaw_deg: 180, pitch_deg: 40}}\n");
  StudyRequest one = request(small(), "one");
  one.coverage_only = true;
  const StudySummary with_one = run_study(one);
  StudyRequest two = request(small("  vehicle: vehicle.yaml\n  vehicle_model: vehicle.glb\n"), "two");
  fs::copy_file(test::repository() / "scenes/agiprobot/vehicle.glb", path("vehicle.glb"));
  two.coverage_only = true;
  const auto floor = *study_measure("floor_coverage"), blind = *study_measure("blind_floor"), ahead = *study_measure("blind_ahead_m");
  const StudySummary with_two = run_study(two);
  EXPECT_GT(with_two.results->candidates[0].measured[floor]->mean, with_one.results->candidates[0].measured[floor]->mean + 0.05);
  EXPECT_LT(with_two.results->candidates[0].measured[blind]->mean, with_one.results->candidates[0].measured[blind]->mean - 0.1);
  EXPECT_GT(with_two.results->candidates[0].measured[ahead]->mean, with_one.results->candidates[0].measured[ahead]->mean);  // its own front
}

}  // namespace
}  // namespace waretwin
