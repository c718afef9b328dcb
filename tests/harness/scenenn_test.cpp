#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/statistics.h"
#include "harness/score/scenenn_paper.h"
#include "harness/score/scenenn_report.h"
#include "harness/score/scenenn_sequences.h"
#include "tests/harness/score_fixtures.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using test::object;

// ---- What the paper prints, held against itself.

std::vector<double> classes_of(const PaperSequence& row) {
  std::vector<double> values;
  for (const auto& value : row.classes) {
    if (value) values.push_back(*value);
  }
  return values;
}

double mean_of_found(const PaperSequence& row) {
  std::vector<double> values = classes_of(row);
  std::erase(values, 0.0);
  return mean(values);
}

// Printed with one decimal, halves either way (31.25 as 31.3), from values that were rounded themselves.
constexpr double kRounding = 0.0501;

TEST(SceneNnPaper, Table2AveragesAreMeansOverAllClasses) {
  for (const PaperSequence& row : paper_table2()) EXPECT_NEAR(mean(classes_of(row)), row.average, kRounding) << row.id;
}

TEST(SceneNnPaper, Table3RepeatsTheAveragesOfTable2) {
  const PaperMethod& ours = paper_table3().back();
  const PaperMethod& voxbloxpp = paper_table3()[1];
  for (std::size_t i = 0; i < kSceneNnSequences.size(); ++i) {
    const PaperSequence& row = paper_table2()[i];
    EXPECT_EQ(row.id, kSceneNnSequences[i]);
    EXPECT_EQ(row.average, ours.sequences[i]) << row.id;
    EXPECT_NEAR(*row.average_voxbloxpp, voxbloxpp.sequences[i], row.id == "223" ? 0.2001 : 0.0) << row.id;
  }
}

TEST(SceneNnPaper, Table3AveragesFollowWhereTheyDo) {
  std::vector<double> means;
  for (const PaperMethod& row : paper_table3()) means.push_back(mean({row.sequences.begin(), row.sequences.end()}));
  EXPECT_NEAR(means[2], paper_table3()[2].average, kRounding) << "Li et al.";
  EXPECT_NEAR(means[3], paper_table3()[3].average, kRounding) << "the paper";
  EXPECT_NEAR(means[0], 42.0, kRounding) << "Pham et al., printed as 43.0";
  EXPECT_NEAR(means[1], 52.4, kRounding) << "Grinvald et al., printed as 54.4";
  // From Table 2's cells on, not from its printed averages.
  std::vector<double> rows;
  for (const PaperSequence& row : paper_table2()) rows.push_back(mean(classes_of(row)));
  EXPECT_NEAR(mean(rows), paper_table3().back().average, kRounding);
}

// docs/metrics.md names these.
TEST(SceneNnPaper, Table1AveragesAreOfTwoKindsOrNone) {
  std::vector<std::string> over_all, over_found_alone, neither;
  for (const PaperSequence& row : paper_table1()) {
    if (std::abs(mean(classes_of(row)) - row.average) <= kRounding) {
      over_all.push_back(row.id);
    } else if (std::abs(mean_of_found(row) - row.average) <= kRounding) {
      over_found_alone.push_back(row.id);
    } else {
      neither.push_back(row.id);
    }
  }
  EXPECT_EQ(over_all, (std::vector<std::string>{"061", "206", "223", "255"}));
  EXPECT_EQ(over_found_alone, (std::vector<std::string>{"086"}));
  EXPECT_EQ(neither, (std::vector<std::string>{"011", "016", "030", "078", "096"}));
}

TEST(SceneNnPaper, Tables1And2HaveTheSameDashes) {
  for (std::size_t i = 0; i < paper_table1().size(); ++i) {
    EXPECT_EQ(paper_table1()[i].id, paper_table2()[i].id);
    for (std::size_t k = 0; k < kSceneNnClasses.size(); ++k) {
      EXPECT_EQ(paper_table1()[i].classes[k].has_value(), paper_table2()[i].classes[k].has_value()) << i << " " << k;
    }
  }
}

TEST(SceneNnPaper, Table4AddsUpToItsTotalAndTable5sRates) {
  double cpu = 0.0, gpu = 0.0;
  for (std::size_t i = 0; i + 1 < paper_table4().size(); ++i) {
    cpu += paper_table4()[i].cpu_ms;
    gpu += paper_table4()[i].gpu_ms;
  }
  EXPECT_NEAR(cpu, paper_table4().back().cpu_ms, 1e-9);
  EXPECT_NEAR(gpu, paper_table4().back().gpu_ms, 1e-9);
  EXPECT_EQ(std::round(1000.0 / cpu), paper_table5()[4].fps);
  EXPECT_EQ(std::round(1000.0 / gpu), paper_table5()[3].fps);
}

// ---- Scores of sequences with closed-form answers.

// Boxes of 2 m x 1 m: moved by 0.4 m along the longer side their IoU is 1.6 / 2.4.
constexpr double kShifted = 1.6 / 2.4;

MappedSequence first_sequence() {
  // Chairs: one exact, one shifted, and a surer one where none is. A sofa of which nothing was found. A lamp that nobody asked for.
  MappedSequence sequence{"011",
                          {object(1, "chair", 0, 0), object(2, "chair", 10.4, 0), object(3, "chair", 30, 0), object(4, "lamp", 0, 5)},
                          {object(1, "chair", 0, 0), object(2, "chair", 10, 0), object(3, "sofa", 5, 5)},
                          StageTimes{.frames = 2, .localise = 1, .detect = 100, .segment = 10, .associate = 2, .integrate = 38}};
  sequence.mapped[0].score = 0.8;
  sequence.mapped[1].score = 0.7;
  sequence.mapped[2].score = 0.9;
  return sequence;
}

MappedSequence second_sequence() {
  // The chair is found; the crate was not seen enough to count.
  MappedSequence sequence{"yard", {object(1, "chair", 0.4, 0)}, {object(1, "chair", 0, 0), object(2, "crate", 5, 5)}, std::nullopt};
  sequence.truth[1].visible_fraction = 0.3;
  return sequence;
}

const ClassScore& class_of(const SequenceScore& sequence, const std::string& name) {
  for (const ClassScore& one : sequence.classes) {
    if (one.class_name == name) return one;
  }
  throw std::out_of_range(name);
}

TEST(SceneNnScore, ScoresEachClassOfASequence) {
  const SceneNnScore score = score_sequences({first_sequence()}, {});
  ASSERT_EQ(score.sequences.size(), 1u);
  const ClassScore& chairs = class_of(score.sequences[0], "chair");
  EXPECT_EQ(chairs.truth, 2);
  EXPECT_EQ(chairs.mapped, 3);
  EXPECT_EQ(chairs.matched, 2);
  EXPECT_NEAR(*chairs.mean_iou3d, (1.0 + kShifted) / 2.0, 1e-12);
  EXPECT_NEAR(*chairs.ap_paper, 2.0 / 3.0, 1e-12);
  // Ranked: wrong, right, right. Precision 1/2 at recall 1/2 and 2/3 at 1; the best precision from either recall on is 2/3.
  EXPECT_NEAR(*chairs.ap50, 2.0 / 3.0, 1e-12);
  const ClassScore& sofas = class_of(score.sequences[0], "sofa");
  EXPECT_EQ(sofas.mapped, 0);
  EXPECT_EQ(*sofas.mean_iou3d, 0.0);
  EXPECT_EQ(*sofas.ap_paper, 0.0);
  EXPECT_EQ(*sofas.ap50, 0.0);
  EXPECT_EQ(score.sequences[0].classes.size(), 2u) << "lamps are of no class that the truth names";
}

TEST(SceneNnScore, TellsTheTwoPrecisionsApart) {
  // One of four chairs is found, and nothing else: TP / (TP + FP) is 1, the area a quarter.
  const SceneNnScore score =
      score_sequences({{"a",
                        {object(1, "chair", 0, 0)},
                        {object(1, "chair", 0, 0), object(2, "chair", 5, 0), object(3, "chair", 10, 0), object(4, "chair", 15, 0)},
                        std::nullopt}},
                      {});
  EXPECT_EQ(*score.map_paper, 1.0);
  EXPECT_NEAR(*score.ap50, 0.25, 1e-12);
  EXPECT_NEAR(*score.mean_iou3d, 0.25, 1e-12);
}

TEST(SceneNnScore, AveragesOverClassesThenSequences) {
  const SceneNnScore score = score_sequences({first_sequence(), second_sequence()}, {});
  const double chairs = (1.0 + kShifted) / 2.0;
  const SequenceScore& first = score.sequences[0];
  const SequenceScore& second = score.sequences[1];
  EXPECT_NEAR(*first.mean_iou3d, chairs / 2.0, 1e-12) << "zeros count";
  EXPECT_NEAR(*first.mean_iou3d_found, chairs, 1e-12);
  EXPECT_NEAR(*first.map_paper, 1.0 / 3.0, 1e-12);
  EXPECT_FALSE(class_of(second, "crate").mean_iou3d.has_value()) << "a dash";
  EXPECT_NEAR(*second.mean_iou3d, kShifted, 1e-12);
  EXPECT_NEAR(*score.mean_iou3d, (chairs / 2.0 + kShifted) / 2.0, 1e-12);
  EXPECT_NEAR(*score.map_paper, (1.0 / 3.0 + 1.0) / 2.0, 1e-12);
  ASSERT_EQ(score.classes.size(), 2u) << "no sequence has a crate that counts";
  EXPECT_EQ(score.classes[0].class_name, "chair");
  EXPECT_EQ(score.classes[0].sequences, 2);
  EXPECT_NEAR(score.classes[0].mean_iou3d, (chairs + kShifted) / 2.0, 1e-12);
  EXPECT_EQ(score.classes[1].class_name, "sofa");
  EXPECT_EQ(score.classes[1].sequences, 1);
  EXPECT_EQ(score.times->frames, 2);
  EXPECT_EQ(score.times->total(), 150.0);
}

TEST(SceneNnScore, OfNothingThatCountsHasNoAverage) {
  MappedSequence empty = second_sequence();
  empty.truth.erase(empty.truth.begin());
  const SceneNnScore score = score_sequences({empty}, {});
  EXPECT_FALSE(score.mean_iou3d || score.map_paper || score.ap50 || score.times);
  EXPECT_NE(scenenn_tables(score, "t").find("| waretwin    | yard "), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(scenenn_json(score))["summary"]["ap50"].is_null());
}

// The summary of two lists and the classes of the same lists are one computation.
TEST(SceneNnScore, AgreesWithTheSummaryOfObjects) {
  const ObjectListScore lists = score_objects(first_sequence().mapped, first_sequence().truth);
  const SceneNnScore score = score_sequences({first_sequence()}, {});
  EXPECT_EQ(score.sequences[0].map_paper, lists.summary.map_paper);
  EXPECT_EQ(score.sequences[0].ap50, lists.summary.ap50);
}

// ---- Tables and JSON.

// The cells of the first row that begins with these two.
std::vector<std::string> cells_of(const std::string& text, const std::string& first, const std::string& second) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    std::string cell;
    std::getline(words, cell, '|');
    while (std::getline(words, cell, '|')) {
      const auto begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
      cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    }
    if (cells.size() > 1 && cells[0] == first && cells[1] == second) return cells;
  }
  return {};
}

using Cells = std::vector<std::string>;

TEST(SceneNnTables, PutOursUnderThePapers) {
  const std::string text = scenenn_tables(score_sequences({first_sequence(), second_sequence()}, {}), "t");
  EXPECT_EQ(cells_of(text, "Zhou et al.", "086"),
            (Cells{"Zhou et al.", "086", "-", "58.2", "-", "0.0", "0.0", "-", "-", "-", "53.8", "56.0", "-"}));
  EXPECT_EQ(cells_of(text, "waretwin", "011"),
            (Cells{"waretwin", "011", "-", "83.3", "0.0", "-", "-", "-", "-", "-", "-", "41.7", "83.3"}));
  EXPECT_EQ(cells_of(text, "waretwin, TP / (TP + FP)", "yard"),
            (Cells{"waretwin, TP / (TP + FP)", "yard", "-", "100.0", "-", "-", "-", "-", "-", "-", "-", "100.0", "-"}));
  // Table 3: 011 stands under the paper's, yard in a column of its own, and 011 alone is shared.
  EXPECT_EQ(cells_of(text, "Li et al. (2020b)", "78.6"), (Cells{"Li et al. (2020b)", "78.6", "25.0", "58.6", "46.6", "69.8", "47.2", "26.6",
                                                                "78.0", "45.8", "75.0", "-", "55.1", "78.6"}));
  EXPECT_EQ(cells_of(text, "waretwin, TP / (TP + FP)", "33.3"),
            (Cells{"waretwin, TP / (TP + FP)", "33.3", "-", "-", "-", "-", "-", "-", "-", "-", "-", "100.0", "66.7", "33.3"}));
  EXPECT_EQ(cells_of(text, "Object Detection", "100.00"), (Cells{"Object Detection", "100.00", "725.00", "7.25", "32.00", "0.32"}));
  EXPECT_EQ(cells_of(text, "FPS (Hz)", "6.67"), (Cells{"FPS (Hz)", "6.67", "0.96", "6.98", "9.80", "0.68"}));
  EXPECT_EQ(cells_of(text, "waretwin", "None (CPU)").back(), "6.67 Hz");
  EXPECT_NE(text.find("not in it: yard."), std::string::npos) << "who has no times";
  EXPECT_NE(text.find("225 for 255"), std::string::npos);
}

TEST(SceneNnTables, HaveColumnsForOtherClassesAndOddNames) {
  MappedSequence sequence{"a|b", {object(1, "conveyor", 0, 0)}, {object(1, "conveyor", 0, 0)}, std::nullopt};
  const std::string text = scenenn_tables(score_sequences({sequence}, {}), "t");
  EXPECT_EQ(cells_of(text, "Source", "Sequence"), (Cells{"Source", "Sequence", "Bed", "Chair", "Sofa", "Table", "Books", "Refrigerator",
                                                         "Television", "Toilet", "Bag", "conveyor", "Avg.", "Avg. of found"}));
  EXPECT_NE(text.find("| a\\|b "), std::string::npos);
  EXPECT_EQ(text.find("Table 4"), std::string::npos) << "nobody has times";
}

TEST(SceneNnJson, HoldsAllNumbers) {
  const auto json = nlohmann::json::parse(scenenn_json(score_sequences({first_sequence(), second_sequence()}, {})));
  EXPECT_EQ(json["protocol"], "scenenn");
  EXPECT_EQ(json["summary"]["sequences"], 2);
  EXPECT_NEAR(json["summary"]["map_paper"].get<double>(), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(json["rules"]["match_iou"], 0.5);
  EXPECT_EQ(json["sequences"][0]["name"], "011");
  EXPECT_EQ(json["sequences"][0]["classes"][0]["matched"], 2);
  EXPECT_TRUE(json["sequences"][1]["classes"][1]["ap_paper"].is_null()) << "the crate";
  EXPECT_TRUE(json["sequences"][1]["timing_ms"].is_null());
  EXPECT_EQ(json["sequences"][0]["timing_ms"]["total"], 150.0);
  EXPECT_NEAR(json["timing_ms"]["paper_cpu_ratio"]["total"].get<double>(), 1046.97 / 150.0, 1e-12);
  EXPECT_NEAR(json["timing_ms"]["paper_gpu_ratio"]["integrate"].get<double>(), 50.0 / 38.0, 1e-12);
  EXPECT_NEAR(json["timing_ms"]["fps"].get<double>(), 1000.0 / 150.0, 1e-12);
  EXPECT_EQ(json["published"]["map_percent"][3]["sequences"]["255"], 100.0);
  EXPECT_EQ(json["published"]["iou3d_percent"][5]["classes"]["bag"], 53.8);
  EXPECT_FALSE(json["published"]["iou3d_percent"][5]["classes"].contains("bed"));
  EXPECT_EQ(json["published"]["ap_percent"][8]["average_voxbloxpp"], 43.8);
}

// ---- Folders.

class SceneNnSequences : public testing::Test {
 protected:
  void put(const fs::path& file, const std::string& text) {
    make_folder((root_.path() / file).parent_path());
    write_file(root_.path() / file, text);
  }
  void put_pair(const std::string& folder) {
    put(folder + "/cuboids.json", truth_json({object(1, "chair", 0, 0)}));
    put(folder + "/truth.json", truth_json({object(1, "chair", 0, 0)}));
  }
  std::vector<std::string> names(const fs::path& map, const fs::path& truth) {
    std::vector<std::string> names;
    for (const MappedSequence& sequence : read_sequences(root_.path() / map, root_.path() / truth)) names.push_back(sequence.name);
    return names;
  }
  void expect_error(const fs::path& map, const fs::path& truth, const std::vector<std::string>& texts) {
    try {
      names(map, truth);
      ADD_FAILURE() << "no error";
    } catch (const Error& e) {
      for (const std::string& text : texts) EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
    }
  }
  test::TemporaryFolder root_;
};

TEST_F(SceneNnSequences, TakesFilesFoldersAndFoldersOfFolders) {
  put_pair("all/016");
  put_pair("all/011");
  put("all/notes.txt", "no sequence");
  make_folder(root_.path() / "all/pictures");
  EXPECT_EQ(names("all", "all"), (std::vector<std::string>{"011", "016"}));
  EXPECT_EQ(names("all/016", "all/016"), (std::vector<std::string>{"016"}));
  EXPECT_EQ(names("all/016/", "all/011"), (std::vector<std::string>{"016"})) << "one map and one truth belong together";
  EXPECT_EQ(names("all/016/cuboids.json", "all/016/truth.json"), (std::vector<std::string>{"016"}));
  put("ours.json", truth_json({}));
  EXPECT_EQ(names("ours.json", "all/016"), (std::vector<std::string>{"ours"}));
  put("truths/016/truth.json", truth_json({}));
  put("truths/011/truth.json", truth_json({}));
  EXPECT_EQ(names("all", "truths").size(), 2u);
}

TEST_F(SceneNnSequences, NamesWhatIsMissing) {
  put_pair("all/011");
  put("all/016/cuboids.json", truth_json({}));
  expect_error("all", "all", {"all/016/truth.json", "sequence '016'", "expected its truth"});
  put("all/016/truth.json", truth_json({}));
  put("all/030/truth.json", truth_json({}));
  expect_error("all", "all", {"all/030/cuboids.json", "sequence '030'", "expected its map"});
  expect_error("all", "all/011/truth.json", {"is one file"});
  expect_error("all/011", "all", {"truth.json", "does not exist"});
  make_folder(root_.path() / "empty");
  expect_error("empty", "all", {"empty", "neither cuboids.json nor folders"});
  expect_error("nowhere", "all", {"nowhere", "does not exist"});
  expect_error("all", "nowhere", {"nowhere", "does not exist"});
}

// SceneNN's own truth is an annotation in the recording's world, in which y may point down.
TEST_F(SceneNnSequences, TakesAnnotationsIntoTheMapsWorld) {
  ListedObject mapped = object(1, "chair", 0, 0);
  mapped.cuboid.centre = Eigen::Vector3d(1, 2, 0.5);
  mapped.cuboid.size = Eigen::Vector3d(0.8, 0.6, 1.0);
  mapped.cuboid.frame = "upright";
  put("maps/011/cuboids.json", truth_json({mapped}));
  // x stays, the recording's y = -z here, its z = y.
  put("maps/011/upright.json", R"({"X_recording_upright": [[1,0,0,0],[0,0,-1,0],[0,1,0,0],[0,0,0,1]]})");
  put("data/011/011.xml", "<annotation><label id=\"7\" nyu_class=\"chair\" obbox=\"1 -0.5 2 0.8 1 0.6 0 0 0 1\"/></annotation>");
  const auto sequences = read_sequences(root_.path() / "maps", root_.path() / "data");
  ASSERT_EQ(sequences.front().truth.size(), 1u);
  EXPECT_NEAR(iou_3d(sequences.front().truth.front().cuboid, mapped.cuboid), 1.0, 1e-9);
  put("data/011/other.xml", "<annotation/>");
  expect_error("maps", "data", {"holds 2 .xml files"});
}

TEST_F(SceneNnSequences, RefusesTwoFrames) {
  put_pair("a");
  ListedObject upright = object(1, "chair", 0, 0);
  upright.cuboid.frame = "upright";
  put("a/cuboids.json", truth_json({upright}));
  expect_error("a", "a", {"cuboids.json", "upright", "world"});
}

TEST_F(SceneNnSequences, ReadsTimesBesideTheMap) {
  put_pair("a");
  // Columns are found by name, in whatever order.
  put("a/timing.csv", "frame,integrate_ms,detect_ms,segment_ms,associate_ms,localise_ms,other\n0,10,100,1,2,3,x\n5,30,300,3,4,5,y\n");
  const auto sequences = read_sequences(root_.path() / "a", root_.path() / "a");
  const StageTimes& times = *sequences.front().times;
  EXPECT_EQ(times.frames, 2);
  EXPECT_EQ(times.detect, 200.0);
  EXPECT_EQ(times.segment, 2.0);
  EXPECT_EQ(times.associate, 3.0);
  EXPECT_EQ(times.integrate, 20.0);
  EXPECT_EQ(times.localise, 4.0);
  EXPECT_EQ(times.total(), 225.0);
  put("a/timing.csv", "frame,integrate_ms,detect_ms,segment_ms,associate_ms,localise_ms\n");
  EXPECT_FALSE(read_sequences(root_.path() / "a", root_.path() / "a").front().times) << "no frame was mapped";
  const std::string head = "integrate_ms,detect_ms,segment_ms,associate_ms,localise_ms\n";
  put("a/timing.csv", head + "1,2,3,4,5\n1,2,3,4\n");
  expect_error("a", "a", {"timing.csv:3", "4 columns", "5"});
  for (const std::string bad : {"fast", "nan", "-1", "1e999", ""}) {
    put("a/timing.csv", head + "1," + bad + ",3,4,5\n");
    expect_error("a", "a", {"timing.csv:2", "'" + bad + "'"});
  }
  put("a/timing.csv", "integrate_ms,detect,segment_ms,associate_ms,localise_ms\n");
  expect_error("a", "a", {"timing.csv:1", "detect_ms"});
}

TEST(StageTimes, CountEachSequenceTheSame) {
  EXPECT_FALSE(mean_times({}).has_value());
  const auto mean = mean_times({StageTimes{.frames = 1, .detect = 100}, StageTimes{.frames = 99, .detect = 300}});
  EXPECT_EQ(mean->frames, 100);
  EXPECT_NEAR(mean->detect, 200.0, 1e-12);
}

}  // namespace
}  // namespace waretwin
