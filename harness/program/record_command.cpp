// waretwin record: a simulated drive as a recording.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "core/error.h"
#include "harness/program/common_options.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"
#include "harness/run/record.h"
#include "sensors/recordings/recording_writer.h"

namespace waretwin {

namespace {

struct RecordOptions {
  CommonOptions common;
  std::string scenario, out, format = "tum";
  std::optional<std::string> camera, laser;
  int frames = 0;
};

// The layout has room for one sensor of a kind: the one that the option names, or the only one.
template <class T>
void keep_one(std::map<std::string, T>& sensors, const std::string& kind, const std::optional<std::string>& name) {
  std::string names;
  for (const auto& entry : sensors) names += (names.empty() ? "" : ", ") + entry.first;
  if (name && !sensors.contains(*name)) {
    throw Error("--" + kind + " " + *name + ": the scenario has no such " + kind + "; expected one of sensors." + kind + "s (" +
                (names.empty() ? "none" : names) + ")");
  }
  if (!name && sensors.size() > 1) {
    throw Error("the scenario has " + std::to_string(sensors.size()) + " " + kind + "s (sensors." + kind + "s: " + names +
                "), a recording in the layout tum holds one; expected --" + kind + " NAME");
  }
  if (name) std::erase_if(sensors, [&](const auto& entry) { return entry.first != *name; });
}

int record(const RecordOptions& options) {
  options.common.apply();
  SimulationConfig simulation;
  simulation.max_frames = options.frames;
  std::vector<Setting> settings;
  if (options.common.seed) settings.push_back({"seed", std::to_string(*options.common.seed)});
  for (Setting& setting : options.common.settings()) settings.push_back(std::move(setting));
  RecordConfig config = load_record_config(options.scenario, simulation, settings);
  keep_one(config.scenario.sensors.cameras, "camera", options.camera);
  keep_one(config.scenario.sensors.lasers, "laser", options.laser);
  const auto scene = std::make_shared<const Scene>(build_scene(config.scenario));
  RecordSummary summary;
  {
    const InterruptWatch watch;
    Progress progress("record", options.common.quiet);
    summary = record_drive(config, scene, record_plan(options.format), options.out, "scenario " + options.scenario,
                           [&](double done, const RecordSummary& so_far) {
                             watch.check("nothing was recorded");
                             progress.update(done, std::to_string(so_far.frames) + " frames, " + std::to_string(so_far.scans) + " scans");
                           })
                  .summary;
  }
  std::cout << summary.frames << " frames, " << summary.scans << " scans and " << summary.readings << " odometry readings in "
            << summary.duration_s << " s\nrecording in " << options.out << " (waretwin map " << options.out << " --out DIR)\n";
  return 0;
}

}  // namespace

Command add_record_command(CLI::App& program) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = program.add_subcommand("record", "a simulated drive as a recording, with the truth beside it");
  command->add_option("SCENARIO", options->scenario, "scenario file")->required();
  command->add_option("--out", options->out, "folder for the recording; an earlier simulated one is replaced once the new one is complete")
      ->required()
      ->type_name("DIR");
  command
      ->add_option(
          "--format", options->format,
          "tum: the layout of TUM RGB-D; scenenn: SceneNN's, with true poses and annotation; rosbag: a ROS 1 bag; 7scenes: 7-Scenes' "
          "and 3DMatch's, with true poses")
      ->capture_default_str()
      ->check(CLI::IsMember(recording_formats()));
  command->add_option("--frames", options->frames, "stops after N camera frames (0: the whole route)")
      ->type_name("N")
      ->check(whole_number())
      ->check(CLI::Range(0, 1000000000));
  command->add_option("--camera", options->camera, "which camera, where the scenario has several")->type_name("NAME");
  command->add_option("--laser", options->laser, "which laser, where the scenario has several")->type_name("NAME");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin record scenes/agiprobot/scenario.yaml --out out/drive\n"
      "  waretwin map out/drive --out out/map --detector out/drive/truth_boxes.json\n"
      "  waretwin score out/map --truth out/drive/truth.json\n"
      "  waretwin record scenes/agiprobot/scenario.yaml --out out/bag --format rosbag --set bag.images=compressed\n\n"
      "Mapped with the same profile and detector, the recording gives the same digest as `waretwin run`. truth.json,\n"
      "trajectory_truth.tum and config.yaml are for scoring and repeating; `map` never reads them. truth_boxes.json holds the boxes of\n"
      "`run --detector truth`. A frame takes about 1.7 MB, in a bag 5.4 MB (compressed 1.7 MB). docs/recordings.md has the layouts.");
  return {command, [options] { return record(*options); }};
}

}  // namespace waretwin
