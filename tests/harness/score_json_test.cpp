#include "harness/score/score_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/harness/score_fixtures.h"

namespace waretwin {
namespace {

using test::object;

TEST(ScoreJson, HoldsTheKeysThatToolsRelyOn) {
  RunScore score;
  score.scenario = "hall";
  score.profile = "paper";
  score.seed = 7;
  score.digest = "0123456789abcdef";
  score.objects = compare_lists({object(5, "c", 0.4, 0)}, {object(1, "c", 0, 0), object(2, "c", 9, 0)});
  score.trajectory = TrajectoryScore{.pairs = 3, .ate_rmse_m = 0.25};
  score.surface = SurfaceScore{.vertices = 8, .median_m = 0.001, .share_over_30mm = 0.5, .found = 0.75};
  for (const char* stage : {"simulate", "localise", "detect", "segment", "associate", "integrate", "frame"}) {
    score.timing_ms[stage] = summarise_timing({1, 2, 3});
  }
  const auto json = nlohmann::json::parse(score_json(score));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["surface"]["median_m"], 0.001);
  EXPECT_EQ(json["surface"]["share_over_30mm"], 0.5);
  EXPECT_EQ(json["surface"]["found"], 0.75);
  EXPECT_EQ(json["scenario"], "hall");
  EXPECT_EQ(json["profile"], "paper");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["digest"], "0123456789abcdef");
  EXPECT_TRUE(json["version"].is_string());
  const auto& row = json["objects"][0];
  EXPECT_EQ(row["truth_id"], 1);
  EXPECT_EQ(row["map_id"], 5);
  EXPECT_EQ(row["class"], "c");
  EXPECT_NEAR(row["iou3d"].get<double>(), 1.6 / 2.4, 1e-12);
  EXPECT_TRUE(row["e_trans_m"].is_number() && row["e_rot_deg"].is_number() && row["visible_fraction"].is_number());
  EXPECT_TRUE(json["objects"][1]["map_id"].is_null());
  for (const char* key :
       {"truth", "mapped", "matched", "recall", "precision", "mean_iou3d", "mean_e_trans_m", "mean_e_rot_deg", "ap50", "map_paper"}) {
    EXPECT_TRUE(json["summary"].contains(key)) << key;
    EXPECT_TRUE(json["summary_aligned"].contains(key)) << key;
  }
  for (const char* key : {"ate_rmse_m", "ate_max_m", "rpe_trans_m", "rpe_rot_deg"}) EXPECT_TRUE(json["trajectory"].contains(key)) << key;
  EXPECT_EQ(json["timing_ms"]["frame"]["median"], 2.0);
  EXPECT_EQ(json["timing_ms"]["frame"]["max"], 3.0);
  EXPECT_NEAR(json["timing_ms"]["frame"]["p95"].get<double>(), 2.9, 1e-12);
  for (const char* key : {"simulated", "mapped", "dropped"}) EXPECT_TRUE(json["frames"].contains(key)) << key;
  EXPECT_TRUE(json.contains("realtime_factor") && json.contains("peak_rss_mb"));
}

TEST(ScoreJson, WritesNullForMeansOverNothing) {
  const auto json = nlohmann::json::parse(score_json(compare_lists({}, {})));
  EXPECT_TRUE(json["summary"]["mean_iou3d"].is_null());
  EXPECT_TRUE(json["summary_aligned"].is_null());
}

TEST(SummariseTiming, OfNothingIsZero) { EXPECT_EQ(summarise_timing({}).max, 0.0); }

}  // namespace
}  // namespace waretwin
