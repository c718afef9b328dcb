#include "harness/run/run_config.h"

#include <algorithm>
#include <array>

#include "core/version.h"

namespace waretwin {

namespace {

bool of_a_group(const Setting& setting) {
  const std::string first = setting.key.substr(0, setting.key.find('.'));
  constexpr std::array kGroups = {"mapper", "simulation", "truth_stages", "truth_detector", "score"};
  return std::find(kGroups.begin(), kGroups.end(), first) != kGroups.end();
}

}  // namespace

void TruthStages::visit(Fields& f) {
  f("detector", detector, "true boxes in place of the detector");
  f("poses", poses, "true poses in place of localisation");
  f("association", association, "true identities in place of association");
}

void RunConfig::visit_groups(Fields& f) {
  f.group("mapper", mapper, "the mapper");
  f.group("simulation", simulation, "how the sensors are simulated");
  f.group("truth_stages", truth_stages, "stages that the truth stands in for");
  f.group("truth_detector", truth_detector, "which objects get a true box");
  f.group("score", score, "how map and truth are compared");
}

void RunConfig::visit(Fields& f) {
  scenario.visit(f);
  visit_groups(f);
}

RunConfig load_run_config(const std::filesystem::path& scenario, RunConfig base, const std::vector<Setting>& settings) {
  base.scenario = load_scenario(scenario);
  if (settings.empty()) return base;
  // On a copy first: the whole tree knows the nearest key of a mistyped one, its parts would not.
  RunConfig whole = base;
  apply_settings(settings, [&](Fields& f) { whole.visit(f); });

  std::vector<Setting> own, grouped;
  for (const Setting& setting : settings) (of_a_group(setting) ? grouped : own).push_back(setting);
  base.scenario = load_scenario(scenario, own);
  apply_settings(grouped, [&](Fields& f) { base.visit_groups(f); });
  return base;
}

std::string resolved_config(const VisitFunction& visit, const std::string& source) {
  return "# waretwin " + std::string(kVersion) + ", " + source + "\n" + write_config([&](Fields& f) {
           std::string version = kVersion;
           f("version", version, "of the program that made this");
           visit(f);
         });
}

}  // namespace waretwin
