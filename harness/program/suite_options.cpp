#include "harness/program/suite_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "core/error.h"
#include "harness/program/found_units.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"
#include "harness/suite/suite.h"
#include "harness/suite/suite_text.h"

namespace waretwin {

void SuiteOptions::add_to(CLI::App& command) {
  CLI::Option* option =
      command.add_option("--suite", suite, "drives the runs of this file in place of SCENARIO, each with its pass marks (docs/gates.md)")
          ->type_name("SUITE");
  CLI::Option* part =
      command
          .add_option("--shard", shard, "with --suite: drives part I of N (I from 0), in the same folder or one to be merged by copying")
          ->type_name("I/N");
  CLI::Option* together = command.add_flag("--merge", merge, "with --suite: drives nothing, and puts together what shards made");
  part->needs(option);
  together->needs(option)->excludes(part);
}

int run_suite_by(const SuiteOptions& options, const CommonOptions& common, const std::vector<Setting>& before, const std::string& out) {
  std::vector<Setting> settings = before;
  if (common.seed) settings.push_back({"seed", std::to_string(*common.seed)});
  for (Setting& setting : common.settings()) settings.push_back(std::move(setting));
  SuiteSummary summary;
  {
    const InterruptWatch watch;
    Progress bar("suite", common.quiet);
    const Shard shard = options.shard.empty() ? Shard() : parse_shard(options.shard);
    SuiteHooks hooks;
    hooks.check = [&] { watch.check("the same command goes on with the runs that are not done"); };
    hooks.progress = [&](const SuiteProgress& now) {
      bar.update((now.number - 1 + now.share) / now.of, std::to_string(now.number) + " of " + std::to_string(now.of) + ", " + now.run);
    };
    summary = run_suite({options.suite, settings, out, shard, options.merge}, hooks);
  }
  print_found(summary.found, summary.found_unwatched, out);
  if (!summary.missing.empty()) {
    std::string names;
    for (const std::string& name : summary.missing) names += (names.empty() ? "" : ", ") + name;
    if (options.merge)
      throw Error(out, "runs of the suite are missing: " + names + "; expected those of all shards, driven by this very program");
    std::printf("this shard is done; of others are missing: %s (the results are put together by whoever finishes last)\n", names.c_str());
    return 0;
  }
  if (summary.kinds_of_cpu > 1)
    spdlog::info("driven on {} kinds of CPU, whose kernels differ in last bits: marks and tolerances hold, digests need not",
                 summary.kinds_of_cpu);
  std::cout << suite_table(summary.name, summary.outcomes) << "\nresults in " << out << " (suite.md, suite.json, junit.xml)\n";
  const auto any = [&](const auto& condition) { return std::any_of(summary.outcomes.begin(), summary.outcomes.end(), condition); };
  if (any([](const SuiteOutcome& outcome) { return !outcome.error.empty(); })) return 2;
  return any([](const SuiteOutcome& outcome) { return !outcome.passed(); }) ? 1 : 0;
}

}  // namespace waretwin
