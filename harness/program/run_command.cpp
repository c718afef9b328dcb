// waretwin run: simulate, map, score.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "harness/gate/comparison_junit.h"
#include "harness/program/common_options.h"
#include "harness/program/external_options.h"
#include "harness/program/gate_options.h"
#include "harness/program/interrupt.h"
#include "harness/program/mapping_options.h"
#include "harness/program/progress.h"
#include "harness/program/suite_options.h"
#include "harness/report/report_file.h"
#include "harness/run/budget.h"
#include "harness/run/external_run.h"
#include "harness/run/run_choice.h"
#include "harness/run/run_folder.h"
#include "harness/score/motion_text.h"
#include "harness/score/number_text.h"
#include "harness/score/score_json.h"
#include "mapper/detect/shipped_models.h"
#include "mapper/detect/yolo_detector.h"

namespace waretwin {

namespace {

struct RunOptions {
  CommonOptions common;
  MappingOptions mapping;
  GateOptions gate;
  SuiteOptions suite;
  std::string scenario, out, baseline;
  bool budget = false;
  ExternalOptions external;
  std::string poses, depth = "sensor", association = "map";
};

RunChoice choice_of(const RunOptions& options) {
  const MappingOptions& mapping = options.mapping;
  return {.profile = mapping.profile,
          .detector = mapping.detector,
          .poses = options.poses,
          .depth = options.depth,
          .association = options.association,
          .rate_hz = mapping.rate_hz,
          .frames = mapping.frames,
          .resume = mapping.resume,
          .extrinsics = mapping.extrinsics,
          .external_mapper = {}};
}

RunConfig configure(const RunOptions& options, std::vector<Setting> given) {
  RunConfig config = chosen_run(choice_of(options));
  std::vector<Setting> settings;
  if (options.common.seed) settings.push_back({"seed", std::to_string(*options.common.seed)});
  for (Setting& setting : options.external.settings()) settings.push_back(std::move(setting));
  for (Setting& setting : given) settings.push_back(std::move(setting));
  return load_run_config(options.scenario, std::move(config), options.mapping.config_file, settings);
}

void print_summary(const char* name, const ScoreSummary& s) {
  if (s.truth == 0) {
    std::cout << name << ": no true object was seen enough to count (" << s.mapped << " mapped)\n";
    return;
  }
  std::cout << name << ": " << s.matched << " of " << s.truth << " objects matched, " << s.mapped << " mapped, mean IoU "
            << number("%.4f", s.mean_iou3d) << ", translation " << number("%.3f m", s.mean_e_trans_m) << ", yaw "
            << number("%.2f deg", s.mean_e_rot_deg) << "\n";
}

// Objects that the model does not know: the map will be without them, and nobody would see why.
void warn_of_strange_classes(const RunConfig& config, const Scene& scene) {
  if (config.truth_stages.detector || config.mapper.detector != "yolo" || scene.objects.empty()) return;
  const std::filesystem::path model = model_or_shipped(config.mapper.model);
  const std::vector<std::string> known = detected_classes(model, config.mapper.detect);
  const auto list = [](const auto& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
  };
  std::set<std::string> strange;
  for (const TrueObject& object : scene.objects) {
    if (std::find(known.begin(), known.end(), object.class_name) == known.end()) strange.insert(object.class_name);
  }
  if (strange.empty()) return;
  spdlog::warn("the detector's model {} does not know {}, which the hall has: it will find none (it knows {})", model.string(),
               list(strange), list(known));
}

void print_explanations(const ComparedLists& objects) {
  for (const Explanation& line : objects.explanations) {
    std::cout << (line.truth_id ? "object " + std::to_string(*line.truth_id) : "mapped object " + std::to_string(*line.map_id)) << ": "
              << line.text << "\n";
  }
}

bool worse_than(const JudgedScore& baseline, const Tolerances& tolerances, const RunOptions& options, const RunScore& score,
                RunFolder& folder) {
  const Comparison comparison = compare_scores(baseline, judged_score(score_json(score), folder.file("score.json")), tolerances);
  const std::string table = comparison_text(comparison);
  folder.write("baseline.md", "Before: " + options.baseline + "\n\n" + table);
  JunitSuite suite = junit_of(comparison, score.scenario);
  if (score.motion) {
    for (const RobotContact& contact : score.motion->contacts)
      suite.cases.push_back({score.scenario, "contact with " + contact.with, {}, contact_text(contact), ""});
  }
  if (!options.gate.junit.empty()) write_file(options.gate.junit, junit_xml({suite}));
  std::cout << "\nbefore: " << options.baseline << "\n\n" << table;
  return comparison.worse();
}

// A route through a station is a mistake of the scenario, or of whoever plans the route: the map that came of it is no answer.
int contacts_or(int code, const RunScore& score) {
  if (!score.motion || score.motion->contacts.empty()) return code;
  for (const RobotContact& contact : score.motion->contacts) spdlog::error("{}", contact_text(contact));
  return 1;
}

int run_with_external_mapper(const RunOptions& options, const RunConfig& config, const std::shared_ptr<const Scene>& scene,
                             const std::function<RunFolder&()>& ready, const std::optional<JudgedScore>& baseline,
                             const Tolerances& tolerances) {
  ExternalRunResult result;
  RunFolder* folder = nullptr;
  {
    const InterruptWatch watch;
    Progress progress("run", options.common.quiet);
    result = run_external(
        config, scene, [&]() -> RunFolder& { return *(folder = &ready()); },
        [&](double done, const std::string& words) {
          watch.check("nothing was scored");
          progress.update(done, words);
        });
  }
  const ShellResult& shell = result.shell;
  write_external(*folder, config, result);
  const std::string failure = result.score ? "" : failure_text(result, folder->path());
  if (!failure.empty()) {
    // An end that was none is the command's failure; a list that cannot be read is bad input.
    if (!shell.timed_out && shell.exit_code == 0) throw Error(failure);
    for (std::size_t i = 0; i + 1 < result.last_words.size(); ++i) std::cerr << "  " << result.last_words[i] << "\n";
    spdlog::error("{}", failure);
    return 1;
  }
  if (const std::string problem = trajectory_text(result, folder->path()); !problem.empty()) spdlog::warn("{}", problem);
  const RunScore& score = *result.score;
  print_summary("as mapped", score.objects.plain.summary);
  if (score.objects.aligned) print_summary("aligned  ", score.objects.aligned->summary);
  print_explanations(score.objects);
  std::cout << "the mapper took " << number("%.1f s", shell.wall_s) << " and " << number("%.0f MB", shell.peak_rss_mb) << "\ndigest "
            << score.digest << "\nresults in " << options.out << " (report.html, table6.md, score.json, mapper/)\n";
  const bool got_worse = baseline && worse_than(*baseline, tolerances, options, score, *folder);
  if (baseline) write_report(folder->path(), ReportKind::kRun);
  return contacts_or(got_worse ? 1 : 0, score);
}

int run(const RunOptions& options) {
  options.common.apply();
  if (!options.suite.suite.empty()) return run_suite_by(options.suite, options.common, options.external.settings(), options.out);
  if (options.scenario.empty()) throw Error("no hall; expected SCENARIO, or --suite SUITE");
  std::vector<Setting> settings = options.common.settings();
  const std::vector<Setting> of_tolerances = take_tolerance_settings(settings);
  if (options.baseline.empty() && !of_tolerances.empty())
    throw Error("--set " + of_tolerances.front().key + ": expected --baseline, which it belongs to");
  const Tolerances tolerances = options.gate.tolerances(of_tolerances);
  options.gate.make_ready();
  // Before the drive, which may replace it.
  std::optional<JudgedScore> baseline;
  if (!options.baseline.empty()) baseline = read_judged_score(options.baseline);
  const RunConfig config = configure(options, std::move(settings));
  if (config.external_mapper.used()) {
    if (options.budget) throw Error("--budget: another mapper has no stages of ours (external_mapper.command); expected one or the other");
    expect_none_of_ours(choice_of(options));
  }
  if (options.budget && !config.resume.empty()) {
    throw Error("--budget: the configuration goes on from a map (resume: " + config.resume +
                "); expected none, for an earlier drive's errors belong to no stage of this one");
  }
  const auto scene = std::make_shared<const Scene>(build_scene(config.scenario));
  std::optional<RunFolder> folder;
  // After all that can be refused, so that an earlier run's results outlive a mistake; before the drive, so that a folder that cannot be
  // written stops the run at once.
  const auto ready = [&] {
    folder.emplace(options.out);
    RunConfig resolved = config;
    folder->write("config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, "scenario " + options.scenario));
  };
  if (config.external_mapper.used()) {
    const auto made = [&]() -> RunFolder& {
      ready();
      return *folder;
    };
    return run_with_external_mapper(options, config, scene, made, baseline, tolerances);
  }
  warn_of_strange_classes(config, *scene);
  ClosedLoopResult result;
  {
    Progress progress("run", options.common.quiet);
    result = run_closed_loop(config, scene, ready, [&](double done, const ObjectMap& map) {
      progress.update(done, std::to_string(map.frames.size()) + " frames mapped, " + std::to_string(map.objects.size()) + " objects");
    });
  }
  write_closed_loop(*folder, result, config.output);
  print_summary("as mapped", result.score.objects.plain.summary);
  if (result.score.objects.aligned) print_summary("aligned  ", result.score.objects.aligned->summary);
  print_explanations(result.score.objects);
  if (options.budget) {
    Progress progress("budget", options.common.quiet);
    const std::vector<BudgetRow> rows = run_budget(config, scene, result.truth, [&](double done) { progress.update(done, ""); });
    folder->write("budget.md", budget_text(rows, result.score.scenario + ", profile " + result.score.profile));
  }
  std::cout << "digest " << result.score.digest << "\nresults in " << options.out << " (report.html, table6.md, score.json"
            << (options.budget ? ", budget.md)\n" : ")\n");
  const bool got_worse = baseline && worse_than(*baseline, tolerances, options, result.score, *folder);
  // Once more, with budget.md and baseline.md.
  if (options.budget || baseline) write_report(folder->path(), ReportKind::kRun);
  return contacts_or(got_worse ? 1 : 0, result.score);
}

}  // namespace

Command add_run_command(CLI::App& program) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "closed loop: simulates a drive through a hall, maps it and scores the map");
  command->add_option("SCENARIO", options->scenario, "scenario file; or --suite");
  command->add_option("--out", options->out, "folder for the results; an earlier run's are replaced")->required()->type_name("DIR");
  options->mapping.add_to(
      *command,
      "yolo: the shipped model conveyor, or that of --set mapper.model=MODEL (default); a model's folder, file or shipped name; "
      "truth: true boxes; none; boxes made elsewhere: a JSON file, or a folder with a text file a frame");
  command->add_option("--poses", options->poses, "laser (default), odometry or truth")
      ->check(CLI::IsMember({"laser", "odometry", "truth"}));
  command->add_option("--depth", options->depth, "sensor or truth")->capture_default_str()->check(CLI::IsMember({"sensor", "truth"}));
  command->add_option("--association", options->association, "map or truth")->capture_default_str()->check(CLI::IsMember({"map", "truth"}));
  command
      ->add_flag("--budget", options->budget,
                 "drives once more (with up to six maps in memory) and maps with the truth in place of each stage in turn: budget.md says "
                 "what each stage costs")
      ->excludes("--resume");
  CLI::Option* own_mapper = options->external.add_to(*command, "DIR/mapper/recording (of a suite: DIR/RUN/mapper/recording)");
  for (const char* ours : {"--profile", "--resume", "--association", "--budget", "--extrinsics", "--config"})
    own_mapper->excludes(command->get_option(ours));
  CLI::Option* baseline =
      command
          ->add_option("--baseline", options->baseline,
                       "an earlier score.json, or its run's folder: exit code 1 where the new score is worse; baseline.md "
                       "in DIR says in what")
          ->type_name("SCORE");
  options->gate.add_to(*command);
  for (const char* judging : {"--tolerances", "--junit"}) command->get_option(judging)->needs(baseline);
  for (const char* settled : {"--poses", "--depth", "--association"}) command->get_option("--config")->excludes(settled);
  options->suite.add_to(*command);
  // Each run of a suite has its own.
  for (const char* own : {"SCENARIO", "--profile", "--detector", "--rate", "--frames", "--resume", "--extrinsics", "--config", "--poses",
                          "--depth", "--association", "--budget", "--baseline"})
    command->get_option("--suite")->excludes(own);
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin run scenes/agiprobot/scenario.yaml --out out/agiprobot --profile paper --detector truth\n"
      "  waretwin run scenes/agiprobot/scenario.yaml --out out/again --config out/agiprobot/config.yaml\n"
      "  waretwin run scenes/agiprobot/scenario.yaml --out out/branch --baseline out/main/score.json --junit out/branch.xml\n"
      "  waretwin run scenes/agiprobot/scenario.yaml --out out/theirs --rate 2 --mapper \"my_mapper {recording} {out}\"\n"
      "  waretwin run --suite scenes/smoke.yaml --out out/smoke\n"
      "  waretwin run --suite theirs.yaml --out out/theirs --mapper \"my_mapper {recording} {out}\"   # in every run of the suite\n\n"
      "`waretwin inspect SCENARIO --keys` lists every key for --set; with --baseline there is tolerances.MEASURE, too (waretwin compare).");
  return {command, [options] { return run(*options); }};
}

}  // namespace waretwin
