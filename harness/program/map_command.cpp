// waretwin map: the mapper on a recording.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "harness/calibrate/extrinsics.h"
#include "harness/program/common_options.h"
#include "harness/program/mapping_options.h"
#include "harness/program/progress.h"
#include "harness/run/map_config.h"
#include "harness/run/run_choice.h"
#include "harness/run/run_folder.h"
#include "mapper/detect/boxes_file.h"

namespace waretwin {

namespace {

struct MapOptions {
  CommonOptions common;
  MappingOptions mapping;
  std::string recording, out, poses;
};

// Boxes of another recording, or of another clock: the map is without objects, and nobody would see why.
void warn_of_unused_boxes(const MapperConfig& config, const MappingResult& result) {
  for (const FrameRow& row : result.frames) {
    if (row.report.detections > 0) return;
  }
  const FrameBoxes boxes = read_boxes(config.boxes, config.detect);
  std::size_t count = 0;
  for (const auto& [stamp, of_frame] : boxes) count += of_frame.size();
  if (result.frames.empty() || boxes.empty()) return;
  const auto seconds = [](Stamp stamp) { return std::to_string(to_seconds(stamp)); };
  spdlog::warn(
      "no mapped frame has a box of {}: it holds {} boxes (after mapper.detect.classes) from {} to {} s, the frames are from {} to {} s",
      config.boxes, count, seconds(boxes.begin()->first), seconds(boxes.rbegin()->first), seconds(result.frames.front().report.stamp),
      seconds(result.frames.back().report.stamp));
}

int map(const MapOptions& options) {
  options.common.apply();
  if (options.mapping.detector == "truth")
    throw Error("--detector truth: a recording holds no true boxes; expected none, a model, or boxes in a file or folder");
  MapConfig config;
  config.mapper = chosen_mapper(options.mapping.profile, options.mapping.detector, options.mapping.rate_hz);
  if (!options.poses.empty()) config.mapper.poses = options.poses;
  config.frames = options.mapping.frames;
  config.resume = options.mapping.resume;
  config.extrinsics = options.mapping.extrinsics;
  // Other people's worlds have their zero anywhere, often at the first camera; our own recordings have it on the floor.
  const std::filesystem::path recording = options.recording;
  const auto folder_of_it = is_recording_file(recording) ? recording.parent_path() : recording;
  if (!std::filesystem::exists(folder_of_it / "recording.yaml")) {
    config.mapper.segment.planes.ground = "lowest_plane";
  }
  if (!options.mapping.config_file.empty()) read_resolved_config(options.mapping.config_file, [&](Fields& f) { config.visit(f); });
  apply_settings(options.common.settings(), [&](Fields& f) { config.visit(f); });

  const auto stream = open_recording(options.recording, config.recording);
  ToldStream told(*stream, told_by_extrinsics(stream->info(), config.extrinsics));
  Stages stages = make_stages(config.mapper, told.info());
  // Before the folder is made: the map may be the one that is there.
  std::optional<LoadedMap> resumed = load_resumed(config.resume, config.mapper.integrate);
  RunFolder folder(options.out);
  MapConfig resolved = config;
  folder.write("config.yaml", resolved_config([&](Fields& f) { resolved.visit(f); }, "recording " + options.recording));
  if (config.mapper.detector == "none" && !stream->info().cameras.empty())
    spdlog::info("no detector was named (--detector): no objects are mapped");
  MappingResult result;
  {
    Progress progress("map", options.common.quiet);
    MappingHooks hooks;
    hooks.progress = [&](double done, const ObjectMap& map) {
      progress.update(done, std::to_string(map.frames.size()) + " frames mapped, " + std::to_string(map.objects.size()) + " objects");
    };
    result = map_stream(told, config.mapper, std::move(stages), config.frames, hooks, std::move(resumed));
  }
  for (const std::string& remark : stream->remarks()) spdlog::info("{}", remark);
  if (config.mapper.detector == "boxes") warn_of_unused_boxes(config.mapper, result);
  if (stream->lost_frames() > 0) spdlog::info("{} frames were left out because their pose was lost", stream->lost_frames());
  write_mapping(folder, result, options.recording, config.mapper.profile, config.output);

  for (const ListedObject& object : listed(result.map.objects)) {
    const Cuboid& c = object.cuboid;
    std::cout << object.id << " " << object.class_name << " at " << c.centre.transpose() << " size " << c.size.transpose() << "\n";
  }
  for (const auto& [reason, count] : result.map.rejected) spdlog::info("not segmented: {}, {} times", reason, count);
  if (result.X_BL) {
    std::cout << result.map.trajectory.size() << " poses of the laser, digest " << digest_of(result.map) << "\nresults in " << options.out
              << " (trajectory.tum, topdown.png, report.html)\n";
    return 0;
  }
  std::cout << result.map.frames.size() << " of " << result.map.frames_seen << " frames mapped, " << result.map.objects.size()
            << " objects, digest " << digest_of(result.map) << "\nresults in " << options.out << " (report.html, map.glb, cuboids.json)\n";
  return 0;
}

}  // namespace

Command add_map_command(CLI::App& program) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command = program.add_subcommand(
      "map", "the mapper on a recording (TUM RGB-D, SceneNN, 7-Scenes or 3DMatch layout, ROS 1 bag, CARMEN laser log)");
  command->add_option("RECORDING", options->recording, "folder of a recording, a ROS 1 bag (.bag), or a CARMEN log (.log, .log.gz)")
      ->required();
  command->add_option("--out", options->out, "folder for the results; an earlier run's are replaced")->required()->type_name("DIR");
  options->mapping.add_to(*command,
                          "none (default: no objects); yolo: the shipped model conveyor, or that of --set mapper.model=MODEL; a model's "
                          "folder, file or shipped name; boxes made elsewhere: a JSON file, or a folder with a text file a frame");
  command
      ->add_option("--poses", options->poses,
                   "laser, odometry or recorded (default: laser where there are scans, else recorded, else odometry)")
      ->check(CLI::IsMember({"laser", "odometry", "recorded"}));
  command->get_option("--config")->excludes("--poses");
  options->common.add_to(*command);
  command->footer(
      "Example:\n  waretwin map recordings/office --out out/office --detector models/yolo-coco\n"
      "  waretwin map drive.bag --out out/drive --set recording.bag.preset=agiprobot --set recording.rotate_deg=180\n"
      "  waretwin map logs/freiburg.log.gz --out out/freiburg\n\n"
      "Of a laser log it is the trajectory alone, as poses of the laser (X_WL). "
      "The ground is the lowest horizontal plane (mapper.segment.planes.ground); in recordings with a recording.yaml it is at height 0.\n"
      "docs/recordings.md says what each layout holds and how to bring your own bag.\n"
      "`waretwin inspect RECORDING --keys` lists every key for --set.");
  return {command, [options] { return map(*options); }};
}

}  // namespace waretwin
