// waretwin score: objects against objects, or a trajectory against a trajectory.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <memory>

#include "core/error.h"
#include "core/files.h"
#include "harness/program/common_options.h"
#include "harness/score/score_json.h"
#include "harness/score/table6.h"

namespace waretwin {

namespace {

struct ScoreOptions {
  CommonOptions common;
  std::string map, truth, out;
};

bool is_object_list(const std::filesystem::path& path) { return std::filesystem::is_directory(path) || path.extension() == ".json"; }

void emit(const ScoreOptions& options, const std::string& json, const std::string& table) {
  std::cout << (table.empty() ? json : table);
  if (options.out.empty()) return;
  make_folder(options.out);
  if (!table.empty()) write_file(std::filesystem::path(options.out) / "table6.md", table);
  write_file(std::filesystem::path(options.out) / "score.json", json);
}

int score(const ScoreOptions& options) {
  options.common.apply();
  ScoringRules rules;
  const std::vector<Setting> settings = options.common.settings();
  struct {
    ScoringRules& rules;
    void visit(Fields& f) { f.group("score", rules, "how map and truth are compared"); }
  } tree{rules};
  apply_settings(settings, [&](Fields& f) { tree.visit(f); });

  if (is_object_list(options.map) != is_object_list(options.truth)) {
    throw Error(options.truth,
                "cannot be compared with " + options.map + ": expected two object lists (.json or a run's folder) or two trajectories");
  }
  if (is_object_list(options.map)) {
    const auto mapped = read_object_list(file_or_in_folder(options.map, "cuboids.json"));
    const auto truth = read_object_list(file_or_in_folder(options.truth, "truth.json"));
    const ComparedLists compared = compare_lists(mapped, truth, rules);
    emit(options, score_json(compared), table6(compared, options.map));
    return 0;
  }
  const auto pairs = associate_poses(read_trajectory(options.map), read_trajectory(options.truth));
  emit(options, score_json(score_trajectory(pairs, TrajectoryAlignment::kNone), score_trajectory(pairs, TrajectoryAlignment::kSe3)), "");
  return 0;
}

}  // namespace

Command add_score_command(CLI::App& program) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command =
      program.add_subcommand("score", "cuboids of any mapper against any truth, or a trajectory against a true one (ATE, RPE)");
  command->add_option("MAP", options->map, "cuboids.json or a run's folder; or a trajectory (TUM or KITTI text)")->required();
  command->add_option("--truth", options->truth, "truth.json or a run's folder; or the true trajectory")->required()->type_name("TRUTH");
  command->add_option("--out", options->out, "folder for score.json and table6.md")->type_name("DIR");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin score cuboids.json --truth truth.json --out out/score\n"
      "  waretwin score trajectory.tum --truth trajectory_truth.tum\n\n"
      "Keys for --set: score.max_centre_distance_m, score.match_iou, score.min_visible_fraction, score.square_ratio.");
  return {command, [options] { return score(*options); }};
}

}  // namespace waretwin
