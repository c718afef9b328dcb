#include "harness/program/gate_options.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "core/files.h"

namespace waretwin {

void GateOptions::add_to(CLI::App& command) {
  command.add_option("--tolerances", tolerance_file, "YAML file with how much worse each measure may be, under the key tolerances")
      ->type_name("FILE");
  command.add_option("--junit", junit, "writes the result as JUnit XML, which CI services show")->type_name("FILE");
}

void GateOptions::make_ready() const {
  const std::filesystem::path folder = std::filesystem::path(junit).parent_path();
  if (!folder.empty()) make_folder(folder);
}

Tolerances GateOptions::tolerances(const std::vector<Setting>& settings) const {
  Tolerances tolerances;
  const auto visit = [&](Fields& f) { f.group("tolerances", tolerances, "how much worse a score may be"); };
  if (!tolerance_file.empty()) read_config(tolerance_file, visit, Completeness::kPartial);
  apply_settings(settings, visit);
  return tolerances;
}

std::vector<Setting> take_tolerance_settings(std::vector<Setting>& settings) {
  const auto first = std::stable_partition(settings.begin(), settings.end(),
                                           [](const Setting& setting) { return !setting.key.starts_with("tolerances."); });
  std::vector<Setting> taken(std::make_move_iterator(first), std::make_move_iterator(settings.end()));
  settings.erase(first, settings.end());
  return taken;
}

}  // namespace waretwin
