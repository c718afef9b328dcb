// waretwin study: which mounting of the sensors maps best.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"
#include "harness/program/common_options.h"
#include "harness/program/external_options.h"
#include "harness/program/found_units.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"
#include "harness/study/preview.h"
#include "harness/study/study.h"
#include "harness/study/study_text.h"

namespace waretwin {

namespace {

struct StudyOptions {
  CommonOptions common;
  ExternalOptions external;
  std::string study, out, shard;
  int jobs = 0;
  bool merge = false, preview = false, coverage = false;
};

int run(const StudyOptions& options) {
  options.common.apply();
  StudyRequest request;
  request.file = options.study;
  request.out = options.out;
  request.settings = options.external.settings();
  for (Setting& setting : options.common.settings()) request.settings.push_back(std::move(setting));
  request.seed = options.common.seed;
  if (!options.shard.empty()) request.shard = parse_shard(options.shard);
  request.merge_only = options.merge;
  request.coverage_only = options.coverage;
  request.jobs = options.jobs;
  StudySummary summary;
  {
    const InterruptWatch watch;
    // A bar a stage.
    std::optional<Progress> bar;
    std::string stage;
    StudyHooks hooks;
    hooks.check = [&] { watch.check("the same command goes on with what is not done"); };
    hooks.progress = [&](const StudyProgress& now) {
      if (!bar || now.stage != stage) bar.emplace("study, " + now.stage, options.common.quiet);
      stage = now.stage;
      bar->update(now.share, std::to_string(now.number) + " of " + std::to_string(now.of) + ", " + now.what);
    };
    if (options.preview) {
      const int drawn = draw_previews(request, hooks);
      bar.reset();
      std::printf("%d candidates drawn: %s/preview.png and preview/\n", drawn, options.out.c_str());
      return 0;
    }
    summary = run_study(request, hooks);
  }
  print_found(summary.found, summary.found_unwatched, options.out);
  if (!summary.results) {
    if (options.merge)
      throw Error(options.out, std::to_string(summary.missing) +
                                   " units of the study are missing; expected those of all shards, made by this very program");
    std::printf(
        "this shard is done; %d of %d runs are missing that belong to others (the results are put together by whoever finishes last)\n",
        summary.missing, summary.runs);
    return 0;
  }
  if (summary.kinds_of_cpu > 1)
    spdlog::info("driven on {} kinds of CPU, whose kernels differ in last bits: differences between mounts may hold as much",
                 summary.kinds_of_cpu);
  const std::vector<std::string> failed = failed_drives(*summary.results);
  for (const std::string& line : failed) spdlog::error("{}", line);
  std::cout << "best: " << summary.verdict << "\nresults in " << summary.folder.string()
            << " (study.md, results.csv, results.json, plots/, coverage/";
  std::cout << (summary.results->best ? ", best/)\n" : ")\n");
  return !failed.empty() && static_cast<int>(failed.size()) == summary.runs ? 1 : 0;
}

}  // namespace

Command add_study_command(CLI::App& program) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* command = program.add_subcommand("study", "which mounting of camera and laser maps best, before a bracket is cut");
  command->add_option("STUDY", options->study, "what varies, over which halls and seeds, and what is judged (docs/studies.md)")->required();
  command->add_option("--out", options->out, "folder for the results; what it has of this study is gone on from")
      ->required()
      ->type_name("DIR");
  CLI::Option* shard =
      command->add_option("--shard", options->shard, "drives part I of N (I from 0), in the same folder or one to be merged by copying")
          ->type_name("I/N");
  CLI::Option* merge = command->add_flag("--merge", options->merge, "drives nothing, and puts together what shards made")->excludes(shard);
  CLI::Option* preview =
      command->add_flag("--preview", options->preview, "draws what each candidate's cameras would see, and drives nothing")
          ->excludes(shard)
          ->excludes(merge);
  command->add_flag("--coverage", options->coverage, "coverage and blind zones of all candidates, without mapping anything")
      ->excludes(preview);
  command
      ->add_option(
          "--jobs", options->jobs,
          "drives at a time, each on one thread and in up to 1 GB; 1: one, on all threads; 0: as many as threads and memory allow, "
          "with another mapper one")
      ->type_name("N")
      ->check(CLI::Range(0, 4096));
  options->external.add_to(*command, "DIR/drives/CANDIDATE-HALL-SEED/mapper/recording");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin study scenes/agiprobot/studies/smoke.yaml --out out/smoke\n"
      "  waretwin study scenes/agiprobot/studies/mount.yaml --out out/mount --preview\n"
      "  waretwin study scenes/agiprobot/studies/mount.yaml --out out/mount --coverage\n"
      "  waretwin study scenes/agiprobot/studies/mount.yaml --out out/theirs --mapper \"my_mapper {recording} {out}\"\n\n"
      "--set also changes the study's own keys, e.g. study.points=64; --seed N replaces its seeds by N, N + 1, ...");
  return {command, [options] { return run(*options); }};
}

}  // namespace waretwin
