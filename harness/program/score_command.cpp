// waretwin score: objects against objects, or a trajectory against a trajectory.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "harness/program/common_options.h"
#include "harness/score/scenenn_report.h"
#include "harness/score/scenenn_sequences.h"
#include "harness/score/score_json.h"
#include "harness/score/table6.h"
#include "harness/score/trajectory_comparison.h"
#include "harness/score/truth_file.h"

namespace waretwin {

namespace {

namespace fs = std::filesystem;

// One option that stands for a key of --set.
struct KeyOption {
  const char* option;
  const char* key;
  std::string value;  // as typed; empty: not given
};

struct ScoreOptions {
  CommonOptions common;
  std::string map, truth, out, protocol;
  KeyOption align{"--align", "trajectory.alignment", ""};
  KeyOption rpe_delta{"--rpe-delta", "trajectory.rpe_delta", ""};
  KeyOption rpe_unit{"--rpe-unit", "trajectory.rpe_unit", ""};
  KeyOption rpe_pairs{"--rpe-pairs", "trajectory.rpe_pairs", ""};
  KeyOption max_time_difference{"--max-time-difference", "trajectory.max_time_difference_s", ""};
  KeyOption time_offset{"--time-offset", "trajectory.time_offset_s", ""};

  std::vector<const KeyOption*> of_trajectories() const {
    return {&align, &rpe_delta, &rpe_unit, &rpe_pairs, &max_time_difference, &time_offset};
  }
};

struct ScoreConfig {
  ScoringRules score;
  TrajectoryRules trajectory;
  void visit(Fields& f) {
    f.group("score", score, "how map and truth are compared");
    f.group("trajectory", trajectory, "how trajectories are compared");
  }
};

ScoreConfig configured(const ScoreOptions& options) {
  std::vector<Setting> settings = options.common.settings();
  for (const KeyOption* option : options.of_trajectories()) {
    if (!option->value.empty()) settings.push_back({option->key, option->value});
  }
  ScoreConfig config;
  apply_settings(settings, [&](Fields& f) { config.visit(f); });
  return config;
}

bool is_object_list(const fs::path& path) { return fs::is_directory(path) || path.extension() == ".json" || path.extension() == ".xml"; }

void refuse_options_of_the_other_kind(const ScoreOptions& options, bool objects) {
  if (!objects && !options.protocol.empty()) {
    throw Error("--protocol " + options.protocol + " compares objects; expected object lists (.json or folders) in place of trajectories");
  }
  if (!objects) return;
  for (const KeyOption* option : options.of_trajectories()) {
    if (!option->value.empty()) {
      throw Error(std::string(option->option) + " compares trajectories; expected TUM or KITTI text in place of object lists");
    }
  }
}

void score_object_lists(const ScoreOptions& options, const ScoringRules& rules) {
  const fs::path map = file_or_in_folder(options.map, "cuboids.json");
  const auto mapped = read_object_list(map);
  const auto truth = read_truth(truth_file(options.truth), map.parent_path());
  const ComparedLists compared = compare_lists(mapped, truth, rules);
  const std::string table = table6(compared, options.map);
  std::cout << table;
  if (options.out.empty()) return;
  make_folder(options.out);
  write_file(fs::path(options.out) / "table6.md", table);
  write_file(fs::path(options.out) / "score.json", score_json(compared));
}

void score_scenenn(const ScoreOptions& options, const ScoringRules& rules) {
  const SceneNnScore result = score_sequences(read_sequences(options.map, options.truth), rules);
  const std::string tables = scenenn_tables(result, options.map);
  std::cout << tables;
  if (options.out.empty()) return;
  make_folder(options.out);
  write_file(fs::path(options.out) / "scenenn.md", tables);
  write_file(fs::path(options.out) / "scenenn.json", scenenn_json(result));
}

void score_trajectories(const ScoreOptions& options, const TrajectoryRules& rules) {
  const std::string json = score_json(compare_trajectories(read_trajectory(options.map), read_trajectory(options.truth), rules));
  std::cout << json;
  if (options.out.empty()) return;
  make_folder(options.out);
  write_file(fs::path(options.out) / "score.json", json);
}

int score(const ScoreOptions& options) {
  options.common.apply();
  const ScoreConfig config = configured(options);
  for (const std::string& path : {options.map, options.truth}) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) throw Error(path, "does not exist; expected an object list, a folder with one, or a trajectory");
  }
  if (is_object_list(options.map) != is_object_list(options.truth)) {
    throw Error(options.truth,
                "cannot be compared with " + options.map + ": expected two object lists (.json, .xml or a folder) or two trajectories");
  }
  const bool objects = is_object_list(options.map);
  refuse_options_of_the_other_kind(options, objects);
  if (!objects) {
    score_trajectories(options, config.trajectory);
  } else if (options.protocol == "scenenn") {
    score_scenenn(options, config.score);
  } else {
    score_object_lists(options, config.score);
  }
  return 0;
}

}  // namespace

Command add_score_command(CLI::App& program) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command =
      program.add_subcommand("score", "cuboids of any mapper against any truth, or a trajectory against a true one (ATE, RPE)");
  command
      ->add_option("MAP", options->map,
                   "cuboids.json or a run's folder (scenenn: or a folder of runs); or a trajectory (TUM or KITTI text)")
      ->required();
  command
      ->add_option("--truth", options->truth,
                   "truth.json, a SceneNN annotation (.xml), or a folder with one of them; or the true trajectory")
      ->required()
      ->type_name("TRUTH");
  command->add_option("--out", options->out, "folder for score.json and table6.md; scenenn: scenenn.json, scenenn.md")->type_name("DIR");
  command
      ->add_option("--protocol", options->protocol,
                   "objects: the paper's Table 6 (default), or its Tables 1 to 5 over one or several sequences")
      ->check(CLI::IsMember({"table6", "scenenn"}));
  const auto add = [&](KeyOption& option, const char* help, const CLI::Validator& check) {
    return command->add_option(option.option, option.value, help)->check(check)->group("Trajectories");
  };
  add(options->align, "before the ATE (default: se3)", CLI::IsMember({"se3", "none"}));
  add(options->rpe_delta, "how far apart the poses of the RPE are (default: 1)", number_from_to(1e-9, 1e9))->type_name("X");
  add(options->rpe_unit, "unit of --rpe-delta (default: frames)", CLI::IsMember({"frames", "metres", "degrees", "seconds"}));
  add(options->rpe_pairs, "pairs end to end, or one from every pose on (default: consecutive)", CLI::IsMember({"consecutive", "all"}));
  add(options->max_time_difference, "stamps this near belong together (default: 0.01)", number_from_to(0, 3600))->type_name("S");
  add(options->time_offset, "added to the stamps of the estimate (default: 0)", number_from_to(-1e9, 1e9))->type_name("S");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin score cuboids.json --truth truth.json --out out/score\n"
      "  waretwin score out/scenenn --truth scenenn --protocol scenenn --out out/tables\n"
      "  waretwin score trajectory.tum --truth trajectory_truth.tum --rpe-delta 1 --rpe-unit metres --rpe-pairs all\n\n"
      "Keys for --set: score.max_centre_distance_m, score.match_iou, score.min_visible_fraction, score.square_ratio; of trajectories "
      "those\n"
      "of the options above and trajectory.rpe_tolerance, trajectory.rpe_from. docs/metrics.md says what each figure means.");
  return {command, [options] { return score(*options); }};
}

}  // namespace waretwin
