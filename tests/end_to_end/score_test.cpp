// waretwin score as a user calls it: settings of trajectories, sequences, and what it says of bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using nlohmann::json;

class ScoreCommand : public testing::Test {
 protected:
  std::string at(const std::string& name) const { return test::in_quotes(folder_.path() / name); }
  void put(const std::string& name, const std::string& text) const {
    make_folder((folder_.path() / name).parent_path());
    write_file(folder_.path() / name, text);
  }
  void put_trajectories() const {
    put("a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2.2 0 0 0 0 0 1\n3 3.2 0 0 0 0 0 1\n");
    put("b.tum", "0 0 0 3 0 0 0 1\n1 1 0 3 0 0 0 1\n2 2 0 3 0 0 0 1\n3 3 0 3 0 0 0 1\n");
    put("k.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2.2 0 1 0 0 0 0 1 0\n1 0 0 3.2 0 1 0 0 0 0 1 0\n");
  }
  static std::string objects(double x) {
    return R"({"objects":[{"id":1,"class":"chair","centre":[)" + std::to_string(x) + R"(,0,0.5],"yaw":0,"size":[2,1,1]}]})";
  }
  void put_sequences() const {
    for (const char* name : {"011", "yard"}) {
      put(std::string("seq/") + name + "/cuboids.json", objects(0.4));
      put(std::string("seq/") + name + "/truth.json", objects(0.0));
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(ScoreCommand, ComparesTrajectoriesBySettings) {
  put_trajectories();
  const std::string score = "score " + at("a.tum") + " --truth " + at("b.tum");
  const auto run = [&](const std::string& options) {
    const auto result = test::waretwin(score + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? json::parse(result.out)["trajectory"] : json();
  };
  const json usual = run("");
  EXPECT_EQ(usual["settings"]["rpe_unit"], "frames");
  EXPECT_NEAR(usual["rpe_trans_m"].get<double>(), 0.2 / std::sqrt(3.0), 1e-9);
  const json plain = run(" --align none --rpe-delta 2 --rpe-unit metres --rpe-pairs all --set trajectory.rpe_from=truth");
  EXPECT_EQ(plain["alignment"], "none");
  EXPECT_NEAR(plain["ate_rmse_m"].get<double>(), std::sqrt((9.0 + 9.0 + 9.04 + 9.04) / 4.0), 1e-9);
  EXPECT_EQ(plain["rpe"]["pairs"], 2);
  EXPECT_NEAR(plain["rpe_trans_m"].get<double>(), 0.2, 1e-9);
  // One second later every estimated pose meets the next true one, and the last one none.
  const json shifted = run(" --align none --time-offset 1 --max-time-difference 0.001");
  EXPECT_EQ(shifted["poses"], 3);

  const auto kitti = test::waretwin("score " + at("k.txt") + " --truth " + at("k.txt") + " --out " + at("out"));
  EXPECT_EQ(kitti.exit_code, 0) << kitti.err;
  EXPECT_EQ(kitti.out, read_file(folder_.path() / "out/score.json"));
  EXPECT_NEAR(json::parse(kitti.out)["trajectory"]["ate_rmse_m"].get<double>(), 0.0, 1e-9);
}

TEST_F(ScoreCommand, SaysWhyItCannotCompareTrajectories) {
  put_trajectories();
  put("single.json", objects(0.0));
  put("later.tum", "100 0 0 0 0 0 0 1\n");
  put("broken.tum", "0 0 0 0 0 0 0 1\n1 0 0 zero 0 0 0 1\n");
  const std::string score = "score " + at("a.tum") + " --truth " + at("b.tum");
  EXPECT_ONE_LINE(test::waretwin(score + " --align sim3"), "--align");
  EXPECT_ONE_LINE(test::waretwin(score + " --rpe-delta nan"), "--rpe-delta");
  EXPECT_ONE_LINE(test::waretwin(score + " --rpe-delta 1.5"), "1.5 frames; expected a whole number");
  EXPECT_ONE_LINE(test::waretwin(score + " --rpe-delta 50 --rpe-unit metres"), "50 metres");
  EXPECT_ONE_LINE(test::waretwin(score + " --protocol scenenn"), "--protocol");
  EXPECT_ONE_LINE(test::waretwin("score " + at("a.tum") + " --truth " + at("later.tum")), "no stamps");
  EXPECT_ONE_LINE(test::waretwin("score " + at("a.tum") + " --truth " + at("broken.tum")), "broken.tum:2");
  EXPECT_ONE_LINE(test::waretwin("score " + at("k.txt") + " --truth " + at("k.txt") + " --rpe-unit seconds"), "no stamps");
  EXPECT_ONE_LINE(test::waretwin("score " + at("single.json") + " --truth " + at("single.json") + " --align none"), "--align");
}

TEST_F(ScoreCommand, PrintsThePapersTablesOverSequences) {
  put_sequences();
  put("seq/yard/timing.csv", "localise_ms,detect_ms,segment_ms,associate_ms,integrate_ms\n1,60,20,10,10\n");
  const auto result = test::waretwin("score " + at("seq") + " --truth " + at("seq") + " --protocol scenenn --out " + at("out"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, read_file(folder_.path() / "out/scenenn.md"));
  for (const char* table : {"## Table 1", "## Table 2", "## Table 3", "## Table 4", "## Table 5", "10.00 Hz"}) {
    EXPECT_NE(result.out.find(table), std::string::npos) << table;
  }
  const json numbers = json::parse(read_file(folder_.path() / "out/scenenn.json"));
  EXPECT_NEAR(numbers["summary"]["mean_iou3d"].get<double>(), 1.6 / 2.4, 1e-12);
  EXPECT_EQ(numbers["summary"]["map_paper"], 1.0);
  EXPECT_EQ(numbers["timing_ms"]["total"], 100.0);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/score.json"));

  const std::string one = "score " + at("seq/011") + " --truth " + at("seq/011");
  EXPECT_EQ(test::waretwin(one).out, test::waretwin(one + " --protocol table6").out) << "the default";
}

TEST_F(ScoreCommand, NamesTheSequenceThatIsNotWhole) {
  put_sequences();
  const std::string score = "score " + at("seq") + " --truth " + at("seq") + " --protocol scenenn --out " + at("out");
  put("seq/late/truth.json", objects(0.0));
  EXPECT_ONE_LINE(test::waretwin(score), "'late' has a truth");
  std::filesystem::remove(folder_.path() / "seq/late/truth.json");
  put("seq/late/cuboids.json", objects(0.0));
  EXPECT_ONE_LINE(test::waretwin(score), "'late' has a map");
  put("seq/late/truth.json", objects(0.0));
  put("seq/late/timing.csv", "frame\n");
  EXPECT_ONE_LINE(test::waretwin(score), "late/timing.csv:1");
  EXPECT_ONE_LINE(test::waretwin("score " + at("nowhere") + " --truth " + at("seq") + " --protocol scenenn"), "nowhere");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out")) << "bad input leaves nothing behind";
}

}  // namespace
}  // namespace waretwin
