#include "harness/suite/suite_text.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/version.h"
#include "harness/gate/junit.h"
#include "harness/gate/markdown_table.h"
#include "harness/score/number_text.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const SuiteOutcome& outcome) {
  Json json = {{"run", outcome.run}, {"passed", outcome.passed()}, {"error", outcome.error}, {"digest", outcome.digest}};
  json["problems"] = outcome.problems;
  json["measures"] = Json::object();
  for (std::size_t i = 0; i < outcome.values.size(); ++i) {
    // Times and memory are another run's every time (they stand in each run's score.json).
    if (measures()[i].tolerance && outcome.values[i]) json["measures"][measures()[i].name] = *outcome.values[i];
  }
  return json;
}

}  // namespace

std::string outcome_json(const SuiteOutcome& outcome) {
  Json json = json_of(outcome);
  json["cpu"] = outcome.cpu;
  return json.dump(2) + "\n";
}

SuiteOutcome read_outcome(const std::string& text, const std::filesystem::path& name) {
  try {
    const Json json = Json::parse(text);
    SuiteOutcome outcome{json.at("run"), json.at("error"), json.at("digest"), json.at("cpu"), json.at("problems"), {}};
    for (const Measure& measure : measures()) {
      const auto value = json.at("measures").find(measure.name);
      outcome.values.push_back(value == json.at("measures").end() ? std::nullopt : std::optional(value->get<double>()));
    }
    return outcome;
  } catch (const Json::exception& e) {
    throw Error(name, "is no result of a suite's run: " + std::string(e.what()));
  }
}

std::string suite_json(const std::string& name, const std::vector<SuiteOutcome>& outcomes) {
  Json json = {{"schema", 1}, {"version", kVersion}, {"suite", name}};
  json["runs"] = Json::array();
  for (const SuiteOutcome& outcome : outcomes) json["runs"].push_back(json_of(outcome));
  return json.dump(2) + "\n";
}

std::string suite_table(const std::string& name, const std::vector<SuiteOutcome>& outcomes) {
  const std::vector<std::pair<std::string, const char*>> shown = {{"recall", "%.3f"},         {"precision", "%.3f"},
                                                                  {"mean_iou3d", "%.4f"},     {"mean_e_trans_m", "%.4f"},
                                                                  {"mean_e_rot_deg", "%.2f"}, {"ate_rmse_m", "%.4f"}};
  std::vector<std::vector<std::string>> rows = {{"run", "verdict"}};
  for (const auto& column : shown) rows.front().push_back(column.first);
  std::string below;
  for (const SuiteOutcome& outcome : outcomes) {
    std::vector<std::string>& row = rows.emplace_back();
    row = {outcome.run, outcome.passed() ? "passed" : outcome.error.empty() ? "**failed**" : "**not run**"};
    for (const auto& [measure, pattern] : shown) {
      std::optional<double> value;
      for (std::size_t i = 0; i < outcome.values.size(); ++i) {
        if (measure == measures()[i].name) value = outcome.values[i];
      }
      row.push_back(number(pattern, value));
    }
    if (!outcome.error.empty()) below += "- " + outcome.run + ": " + outcome.error + "\n";
    for (const std::string& problem : outcome.problems) below += "- " + outcome.run + ": " + problem + "\n";
  }
  return "# " + name + "\n\n" + markdown_table(rows, 2) + (below.empty() ? "" : "\n" + below);
}

std::string suite_junit(const std::string& name, const std::vector<SuiteOutcome>& outcomes) {
  JunitSuite suite{name, {}};
  for (const SuiteOutcome& outcome : outcomes) {
    JunitCase& one = suite.cases.emplace_back(JunitCase{name, outcome.run, {}, "", outcome.error});
    for (const std::string& problem : outcome.problems) one.failure += (one.failure.empty() ? "" : "\n") + problem;
  }
  return junit_xml({suite});
}

}  // namespace waretwin
