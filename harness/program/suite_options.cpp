#include "harness/program/suite_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "core/error.h"
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

int run_suite_by(const SuiteOptions& options, const CommonOptions& common, const std::string& out) {
  std::vector<Setting> settings;
  if (common.seed) settings.push_back({"seed", std::to_string(*common.seed)});
  for (Setting& setting : common.settings()) settings.push_back(std::move(setting));
  SuiteSummary summary;
  {
    const InterruptWatch watch;
    Progress bar("suite", common.quiet);
    const Shard shard = options.shard.empty() ? Shard() : parse_shard(options.shard);
    summary = run_suite({options.suite, settings, out, shard, options.merge}, [&](const SuiteProgress& now) {
      watch.check("the same command goes on with the runs that are not done");
      bar.update((now.number - 1 + now.share) / now.of, std::to_string(now.number) + " of " + std::to_string(now.of) + ", " + now.run);
    });
  }
  if (summary.found > 0)
    std::printf("%d runs were there already, of this program and configuration (%s/units)\n", summary.found, out.c_str());
  if (summary.missing > 0) {
    if (options.merge) throw Error(out, std::to_string(summary.missing) + " runs of the suite are missing; expected those of all shards");
    std::printf("this shard is done; %d runs of others are missing: the results are put together by whoever finishes last\n",
                summary.missing);
    return 0;
  }
  std::cout << suite_table(summary.name, summary.outcomes) << "\nresults in " << out << " (suite.md, suite.json, junit.xml)\n";
  const auto any = [&](const auto& condition) { return std::any_of(summary.outcomes.begin(), summary.outcomes.end(), condition); };
  if (any([](const SuiteOutcome& outcome) { return !outcome.error.empty(); })) return 2;
  return any([](const SuiteOutcome& outcome) { return !outcome.passed(); }) ? 1 : 0;
}

}  // namespace waretwin
