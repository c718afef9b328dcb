// run --budget: what each stage costs, on a drive of five seconds to station 1.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/end_to_end/program.h"

namespace waretwin {
namespace {

using test::agiprobot;
using test::in_quotes;
using test::TemporaryFolder;
using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string drive(const fs::path& out) {
  return "run " + agiprobot() + " --quiet --frames 11 --out " + in_quotes(out) +
         " --set sensors.cameras.camera.preset=azure_kinect_gaussian --set sensors.cameras.camera.rate_hz=2"
         " --set sensors.cameras.camera.width=480 --set sensors.cameras.camera.height=270 --set robot.speed_mps=1"
         " --set robot.acceleration_mps2=1 --set robot.turn_rate_deg_s=90 --set robot.turn_acceleration_deg_s2=180 ";
}

struct Table {
  std::vector<std::string> stages;                         // in the order of the rows
  std::map<std::string, std::vector<std::string>> values;  // matched, mapped, IoU, m, deg, trajectory, costs in IoU, m, deg
};

Table table_in(const fs::path& file) {
  Table table;
  std::istringstream lines(read_file(file));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ") || line.starts_with("| stage")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) {
      const auto from = cell.find_first_not_of(' ');
      cells.push_back(from == std::string::npos ? "" : cell.substr(from, cell.find_last_not_of(' ') + 1 - from));
    }
    table.stages.push_back(cells.front());
    table.values[cells.front()] = {cells.begin() + 1, cells.end()};
  }
  return table;
}

const std::vector<std::string> kStages = {"as configured", "true poses", "true boxes", "true depth", "true association", "all true"};

TEST(Budget, PutsTheTruthInPlaceOfEachStage) {
  const TemporaryFolder folder;
  const auto with_boxes = test::waretwin(drive(folder.path() / "boxes") + "--budget --detector truth");
  ASSERT_EQ(with_boxes.exit_code, 0) << with_boxes.err;
  const Table boxes = table_in(folder.path() / "boxes/budget.md");
  ASSERT_EQ(boxes.stages, kStages);
  EXPECT_EQ(boxes.values.at("true boxes").front(), "the configuration has it already");
  for (const auto& [stage, values] : boxes.values) {
    SCOPED_TRACE(stage);
    ASSERT_EQ(values.size(), 9u);
    if (stage == "true boxes") continue;
    EXPECT_EQ(values[0], "1 of 1");
    const std::size_t columns = stage == "as configured" ? 6 : 9;
    for (std::size_t k = 1; k < columns; ++k) {
      char* end = nullptr;
      EXPECT_TRUE(std::isfinite(std::strtod(values[k].c_str(), &end))) << values[k];
      EXPECT_TRUE(end != values[k].c_str() && *end == '\0') << "'" << values[k] << "' is no number";
    }
    const double cost = std::stod(values[2]) - std::stod(boxes.values.at("as configured")[2]);
    if (columns == 9) {
      EXPECT_NEAR(std::stod(values[6]), cost, 0.0011);
    }
  }
  EXPECT_EQ(boxes.values.at("true poses")[5], "0.0000");
  EXPECT_EQ(boxes.values.at("true depth")[5], boxes.values.at("as configured")[5]) << "depth tells nothing about the path";

  // Rows are what runs with the same truths would have scored: without boxes, and with the truth in place of all.
  const auto without_boxes = test::waretwin(drive(folder.path() / "none") + "--budget --detector none");
  ASSERT_EQ(without_boxes.exit_code, 0) << without_boxes.err;
  const Table none = table_in(folder.path() / "none/budget.md");
  ASSERT_EQ(none.stages, kStages);
  EXPECT_EQ(none.values.at("as configured")[0], "0 of 1");
  const auto figures = [](const Table& table, const std::string& stage) {
    const std::vector<std::string>& values = table.values.at(stage);
    return std::vector<std::string>(values.begin(), values.begin() + 6);
  };
  EXPECT_EQ(figures(none, "true boxes"), figures(boxes, "as configured"));
  EXPECT_EQ(figures(none, "all true"), figures(boxes, "all true"));
  const auto all = test::waretwin(drive(folder.path() / "all") + "--detector truth --poses truth --depth truth --association truth");
  ASSERT_EQ(all.exit_code, 0) << all.err;
  const Json summary = Json::parse(read_file(folder.path() / "all/score.json"))["summary"];
  EXPECT_NEAR(summary["mean_iou3d"].get<double>(), std::stod(boxes.values.at("all true")[2]), 0.00051);
  EXPECT_NEAR(summary["mean_e_trans_m"].get<double>(), std::stod(boxes.values.at("all true")[3]), 0.000051);
  EXPECT_FALSE(fs::exists(folder.path() / "all/budget.md"));
}

TEST(Budget, StartsFromNoMap) {
  const TemporaryFolder folder;
  const std::string budget = drive(folder.path() / "out") + "--budget ";
  EXPECT_ONE_LINE(test::waretwin(budget + "--resume map.waretwin"), "--budget");
  EXPECT_ONE_LINE(test::waretwin(budget + "--set resume=map.waretwin"), "--budget");
  const fs::path config = folder.path() / "config.yaml";
  write_file(config, "resume: map.waretwin\n");
  const std::string repeated = "run " + agiprobot() + " --budget --out '" + (folder.path() / "out").string() + "' --config '";
  EXPECT_ONE_LINE(test::waretwin(repeated + config.string() + "'"), "resume: map.waretwin");
  EXPECT_FALSE(fs::exists(folder.path() / "out")) << "bad input leaves nothing behind";
}

}  // namespace
}  // namespace waretwin
