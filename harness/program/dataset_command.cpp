// waretwin dataset: labelled training pictures.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include "core/error.h"
#include "harness/dataset/dataset_maker.h"
#include "harness/program/common_options.h"
#include "harness/program/freed_memory.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"
#include "harness/report/report_file.h"

namespace waretwin {

namespace {

struct DatasetOptions {
  CommonOptions common;
  std::vector<std::string> scenarios, styles, formats;
  std::string out, shard;
  std::optional<int> count, samples;
  std::optional<std::string> quality;
};

std::string time_text(double seconds) {
  char text[32];
  const int whole = static_cast<int>(seconds + 0.5);
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%d h %02d min", whole / 3600, whole / 60 % 60);
  } else if (whole >= 60) {
    std::snprintf(text, sizeof text, "%d min %02d s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%d s", whole);
  }
  return text;
}

int dataset(const DatasetOptions& options) {
  options.common.apply();
  keep_freed_memory();
  DatasetConfig config;
  if (options.common.seed) config.seed = *options.common.seed;
  if (options.count) config.count = *options.count;
  if (options.quality) config.render.quality = *options.quality;
  if (options.samples) config.render.samples = *options.samples;
  std::vector<Setting> own, of_scenarios;
  for (const Setting& setting : options.common.settings()) (setting.key.starts_with("dataset.") ? own : of_scenarios).push_back(setting);
  struct {
    DatasetConfig& config;
    void visit(Fields& f) { f.group("dataset", config, "a set of training pictures"); }
  } tree{config};
  apply_settings(own, [&](Fields& f) { tree.visit(f); });
  DatasetFormats formats;
  if (!options.formats.empty()) {
    const auto asked = [&](const char* name) {
      return std::find(options.formats.begin(), options.formats.end(), name) != options.formats.end();
    };
    formats = {asked("yolo"), asked("coco")};
  }
  const Shard shard = options.shard.empty() ? Shard() : parse_shard(options.shard);
  std::vector<std::unique_ptr<HallSource>> sources;
  for (const std::string& file : options.scenarios) sources.push_back(scenario_source(file, of_scenarios));
  for (const std::string& style : options.styles) sources.push_back(generated_source(style, config.seed, of_scenarios));
  if (sources.empty()) throw Error("no halls; expected scenario files or --generate STYLE");
  if (options.scenarios.size() == sources.size() && config.valid_share + config.test_share > 0.0) {
    spdlog::info("all splits show the same layouts: AP on them says little of other halls");
  }

  DatasetSummary summary;
  {
    const InterruptWatch watch;
    Progress progress("dataset", options.common.quiet);
    const auto begin = std::chrono::steady_clock::now();
    summary = make_dataset(config, sources, options.out, formats, shard, [&](const DatasetProgress& now) {
      watch.check("the same command goes on from here");
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const int made = now.done - now.found;
      char text[96];
      const double rate = seconds > 0.0 ? made / seconds : 0.0;
      if (made > 0) {
        std::snprintf(text, sizeof text, "%d of %d pictures, %.1f/s, %s left", now.done, now.of, rate,
                      time_text((now.of - now.done) / rate).c_str());
      } else {
        std::snprintf(text, sizeof text, "%d of %d pictures there already", now.found, now.of);
      }
      progress.update(now.of > 0 ? static_cast<double>(now.done) / now.of : 1.0, text);
    });
  }
  if (summary.missing_halls > 0) {
    std::printf("this shard is done; %d halls of others are missing: the lists are made by whoever finishes last\n", summary.missing_halls);
    return 0;
  }
  write_report(options.out, ReportKind::kDataset);
  std::printf("%d pictures, %d of them without labels\n", summary.images, summary.empty);
  for (std::size_t i = 0; i < summary.classes.size(); ++i)
    std::printf("  %-20s %6d labels\n", summary.classes[i].c_str(), summary.labels[i]);
  std::printf("visible but left out: %d mostly hidden, %d too small\n", summary.hidden, summary.small);
  if (config.valid_share > 0.0 && summary.splits.count("valid") == 0) {
    spdlog::info("no split 'valid', which training needs: {} pictures are of {} halls; a smaller dataset.images_per_hall makes more",
                 summary.images, (summary.images + config.hall_size() - 1) / config.hall_size());
  }
  std::cout << "set in " << options.out << " (waretwin train " << options.out << " --out DIR); report.html shows it\n";
  return 0;
}

}  // namespace

Command add_dataset_command(CLI::App& program) {
  auto options = std::make_shared<DatasetOptions>();
  CLI::App* command = program.add_subcommand("dataset", "labelled training pictures of a detector, from scenarios and random halls");
  command->add_option("SCENARIO", options->scenarios, "scenario files whose halls are photographed, in turn");
  command
      ->add_option("--generate", options->styles, "halls drawn on the fly, a new one each time: cell, warehouse, flat or home (repeatable)")
      ->type_name("STYLE")
      ->check(CLI::IsMember({"cell", "warehouse", "flat", "home"}));
  command->add_option("--out", options->out, "folder of the set; one that is half done is gone on with")->required()->type_name("DIR");
  command->add_option("--count", options->count, "pictures in all (default 100)")
      ->type_name("N")
      ->check(whole_number())
      ->check(CLI::Range(1, 10000000));
  command->add_option("--format", options->formats, "yolo: labels/ and Darknet's lists; coco: annotations/ (repeatable; default: both)")
      ->check(CLI::IsMember({"yolo", "coco"}));
  command->add_option("--shard", options->shard, "makes part I of N (I from 0), in the same folder or one to be merged by copying")
      ->type_name("I/N");
  command->add_option("--quality", options->quality, "fast: direct light; path: path tracing (default: fast)")
      ->check(CLI::IsMember({"fast", "path"}));
  command->add_option("--samples", options->samples, "rays a pixel in quality path (default 16)")
      ->type_name("N")
      ->check(CLI::Range(1, 65536));
  options->common.add_to(*command);
  command->get_option("--seed")->description("another set; the same seed gives the same bytes, however it is sharded (default 1)");
  command->footer(
      "Example:\n  waretwin dataset --generate cell --out data/conveyors --count 1000\n"
      "  waretwin dataset my/scenario.yaml --out data/mine --count 500 --set dataset.labels.min_visible=0.5\n"
      "  waretwin dataset --generate cell --generate warehouse --out data/big --count 5000 --shard 0/2   # and 1/2 beside it\n\n"
      "--set takes dataset.* (docs/datasets.md lists them) and the scenarios' own keys.");
  return {command, [options] { return dataset(*options); }};
}

}  // namespace waretwin
