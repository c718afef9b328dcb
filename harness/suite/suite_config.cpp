#include "harness/suite/suite_config.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "core/error.h"

namespace waretwin {

namespace {

// Of a suite's own folder.
const std::set<std::string> kTaken = {"halls", "units", "suite.json", "suite.md", "junit.xml"};

bool names_a_folder(const std::string& name) {
  return !kTaken.contains(name) && !name.empty() && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.'; });
}

}  // namespace

void SuiteRun::visit(Fields& f) {
  f("scenario", scenario, "scenario file, from the suite's folder; or `generate`");
  f.group("generate", generate, "a hall drawn as `waretwin generate` does; `style` must be named");
  choice.visit(f);
  f("config", config, "an earlier run's config.yaml, or a part of one, from the suite's folder");
  f("set", set, "key=value, as for run --set");
  f("baseline", baseline, "score.json that the score must not be worse than, from the suite's folder");
  f.group("pass", pass, "what the score must reach");
  // Of the whole process, not of the run.
  for (std::size_t i = 0; i < measures().size(); ++i) {
    if (std::string(measures()[i].name) == "peak_rss_mb" && pass.measures.values[i])
      f.reject("pass", "peak_rss_mb is no run's own in a suite; expected none");
  }
  const RunChoice usual;
  const bool chosen = choice.profile != usual.profile || choice.detector || !choice.poses.empty() || choice.depth != usual.depth ||
                      choice.association != usual.association || choice.rate_hz || choice.frames != 0 || choice.external_mapper.used();
  if (!config.empty() && chosen)
    f.reject("config",
             "settles profile, detector, poses, depth, association, rate_hz, frames and external_mapper; expected none of them beside it");
  check_hall_source(f, scenario, generate);
}

void SuiteConfig::visit(Fields& f) {
  f("name", name, "of the suite, in reports");
  f.map("runs", runs, "runs by name");
  f.group("tolerances", tolerances, "how much worse than its baseline a score may be");
  f.group("external_mapper", external_mapper,
          "another mapper in place of ours, for each run; what a run's own external_mapper names counts more");
}

SuiteConfig read_suite(const std::filesystem::path& file) {
  SuiteConfig first;
  read_config(file, [&](Fields& f) { f.group("suite", first, "runs with pass marks"); });
  // Once more over the suite's own mapper, key by key.
  SuiteConfig suite;
  for (const auto& entry : first.runs) suite.runs[entry.first].choice.external_mapper = first.external_mapper;
  read_config(file, [&](Fields& f) { f.group("suite", suite, "runs with pass marks"); });
  if (suite.runs.empty()) throw Error(file, "suite.runs is empty; expected runs by name");
  for (const auto& entry : suite.runs) {
    if (!names_a_folder(entry.first))
      throw Error(file,
                  "suite.runs: '" + entry.first + "'; expected a name of letters, digits, '-', '_' and '.', and none of halls and units");
  }
  return suite;
}

}  // namespace waretwin
