// waretwin compare: what got better and what got worse from one score to another.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "core/files.h"
#include "harness/gate/comparison.h"
#include "harness/gate/comparison_junit.h"
#include "harness/program/common_options.h"
#include "harness/program/gate_options.h"

namespace waretwin {

namespace {

struct CompareOptions {
  CommonOptions common;
  GateOptions gate;
  std::string before, after;
};

int compare(const CompareOptions& options) {
  options.common.apply();
  const Tolerances tolerances = options.gate.tolerances(options.common.settings());
  const Comparison comparison = compare_scores(read_judged_score(options.before), read_judged_score(options.after), tolerances);
  std::cout << comparison_text(comparison);
  options.gate.make_ready();
  if (!options.gate.junit.empty()) write_file(options.gate.junit, junit_xml({junit_of(comparison, "compare " + options.after)}));
  return comparison.worse() ? 1 : 0;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = program.add_subcommand("compare", "what got better and worse from one score to another; exit code 1 on worse");
  command->add_option("BEFORE", options->before, "score.json or a run's folder")->required();
  command->add_option("AFTER", options->after, "score.json or a run's folder")->required();
  options->gate.add_to(*command);
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin compare baseline/score.json out/agiprobot --junit compare.xml\n"
      "  waretwin compare out/main out/branch --set tolerances.mean_iou3d=0.01 --set tolerances.frame_median_ms=20\n\n"
      "A measure may get worse by its tolerance, in its own unit; null leaves it unjudged, as times are unless they have one. "
      "docs/gates.md "
      "lists all.");
  return {command, [options] { return compare(*options); }};
}

}  // namespace waretwin
