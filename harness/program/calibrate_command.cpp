// waretwin calibrate: where the camera sits, from a checkerboard that camera and laser both see.
#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "harness/calibrate/calibrate_config.h"
#include "harness/calibrate/calibration_report.h"
#include "harness/calibrate/extrinsics.h"
#include "harness/program/common_options.h"
#include "harness/program/progress.h"

namespace waretwin {

namespace {

struct CalibrateOptions {
  CommonOptions common;
  std::string source, out;
  std::string board, camera, laser;
  std::optional<double> square_m;
  bool intrinsics = false;
};

// "9x6".
void take_board(const std::string& text, CheckerBoard& board) {
  const auto x = text.find('x');
  const auto whole = [&](std::size_t from, std::size_t to, int& value) {
    const auto [end, status] = std::from_chars(text.data() + from, text.data() + to, value);
    return status == std::errc() && end == text.data() + to && value >= 3 && value <= 50;
  };
  if (x == std::string::npos || !whole(0, x, board.columns) || !whole(x + 1, text.size(), board.rows)) {
    throw Error("--board " + text + ": expected inner corners COLUMNSxROWS, each from 3 to 50, e.g. 9x6");
  }
}

CalibrateConfig chosen(const CalibrateOptions& options) {
  CalibrateConfig config;
  if (!options.board.empty()) take_board(options.board, config.board);
  if (options.square_m) config.board.square_m = *options.square_m;
  config.camera = options.camera;
  config.laser = options.laser;
  config.lens.estimate = options.intrinsics;
  return config;
}

Calibration watched(SensorStream& stream, const CalibrateConfig& config, bool quiet) {
  Progress progress("calibrate", quiet);
  return calibrate(stream, config, [&](double done, int poses) { progress.update(done, std::to_string(poses) + " board poses"); });
}

int calibrate_from(const CalibrateOptions& options) {
  options.common.apply();
  expect_refinement();
  const std::filesystem::path source = options.source, out = options.out;
  if (std::filesystem::is_directory(out)) throw Error(out, "is a folder; expected the name of a file");
  if (out.has_parent_path() && !std::filesystem::is_directory(out.parent_path())) {
    throw Error(out, "cannot be written: there is no folder '" + out.parent_path().string() + "'");
  }
  const std::vector<Setting> settings = options.common.settings();
  Calibration calibration;
  std::optional<CalibrationTruth> truth;
  if (std::filesystem::is_directory(source) || is_carmen_log(source)) {
    if (options.common.seed) throw Error("--seed: a recording has none; expected a scenario");
    RecordedCalibrationConfig config;
    config.calibrate = chosen(options);
    apply_settings(settings, [&](Fields& f) { config.visit(f); });
    const auto stream = open_recording(source, config.recording);
    calibration = watched(*stream, config.calibrate, options.common.quiet);
  } else {
    SimulatedCalibrationConfig config;
    config.scenario = load_scenario(source);
    config.calibrate = chosen(options);
    if (options.common.seed) config.scenario.seed = *options.common.seed;
    apply_settings(settings, [&](Fields& f) { config.visit(f); });
    if (config.scenario.motion.held.empty()) {
      throw Error(source, "holds up no board (motion.held); expected a scenario of its own, as scenes/agiprobot/calibration.yaml");
    }
    SimulatedStream stream(config.scenario, std::make_shared<const Scene>(build_scene(config.scenario)), config.simulation);
    calibration = watched(stream, config.calibrate, options.common.quiet);
    truth = true_calibration(config.scenario, calibration.camera, calibration.laser);
  }
  write_file(out, extrinsics_yaml(extrinsics_of(calibration), options.source));
  const std::filesystem::path report = out.string() + ".report.json";
  write_file(report, calibration_json(calibration, truth));
  std::cout << calibration_text(calibration, truth) << "extrinsics in " << out.string() << " (waretwin run SCENARIO --extrinsics "
            << out.string() << "), figures in " << report.string() << "\n";
  return 0;
}

}  // namespace

Command add_calibrate_command(CLI::App& program) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      program.add_subcommand("calibrate", "where the camera sits on the vehicle, from a checkerboard that camera and laser both see");
  command->add_option("SCENARIO|RECORDING", options->source, "scenario in which a board is held up, or a recording of one with laser scans")
      ->required();
  command->add_option("--out", options->out, "extrinsics for --extrinsics of run and map; FILE.report.json beside it holds every figure")
      ->required()
      ->type_name("FILE");
  command->add_option("--board", options->board, "inner corners of the checkerboard (default 9x6)")->type_name("COLUMNSxROWS");
  command->add_option("--square", options->square_m, "edge of its squares in metres (default 0.07)")
      ->type_name("M")
      ->check(number_from_to(0.001, 2.0));
  command->add_option("--camera", options->camera, "which camera, where there are several")->type_name("NAME");
  command->add_option("--laser", options->laser, "which laser, where there are several")->type_name("NAME");
  command->add_flag("--intrinsics", options->intrinsics, "estimates the camera's intrinsics, too, and tells them beside the given ones");
  options->common.add_to(*command);
  command->footer(
      "Examples:\n  waretwin calibrate scenes/agiprobot/calibration.yaml --out extrinsics.yaml\n"
      "  waretwin calibrate recordings/board --out extrinsics.yaml --board 9x6 --square 0.07\n"
      "  waretwin map recordings/drive --extrinsics extrinsics.yaml --out out/map\n\n"
      "The vehicle stands; the board is held still for a second or more in each of 20 poses, turned and tilted differently "
      "(docs/calibration.md).\n"
      "Of a scenario the error against the truth is told, too. Keys for --set: `calibrate.` with board.columns, still.still_px,\n"
      "guess.distance_m, refine.range_bias_m, lens.distortion ... (all of them: docs/calibration.md), those of the scenario and "
      "`simulation.`,\n"
      "or of a recording `recording.`.");
  return {command, [options] { return calibrate_from(*options); }};
}

}  // namespace waretwin
