// waretwin inspect: what is in a file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <variant>

#include "core/error.h"
#include "core/files.h"
#include "harness/noise/noise_report.h"
#include "harness/program/common_options.h"
#include "harness/program/inspect_motion.h"
#include "harness/program/progress.h"
#include "harness/run/map_config.h"
#include "harness/run/run_config.h"
#include "harness/score/cuboid_file.h"
#include "harness/score/trajectory_file.h"
#include "mapper/integrate/tsdf_volume.h"
#include "mapper/output/map_archive.h"
#include "scenes/describe.h"
#include "scenes/gltf_loader.h"
#include "sim/robot.h"

namespace waretwin {

namespace {

struct InspectOptions {
  CommonOptions common;
  std::string file;
  bool keys = false;
  std::optional<double> motion_s;
  bool noise = false;
  int frames = 0;
  double reflectivity = 0.0;
  std::string json;
};

// What a recording is inspected with.
struct InspectConfig {
  RecordingConfig recording;
  NoiseConfig noise;
  void visit(Fields& f) {
    f.group("recording", recording, "how the recording is read");
    f.group("noise", noise, "how --noise measures");
  }
};

void describe_objects(const std::vector<ListedObject>& objects) {
  std::cout << objects.size() << " objects\n";
  for (const ListedObject& object : objects) {
    const Cuboid& c = object.cuboid;
    std::cout << "  " << object.id << " " << object.class_name << ": centre " << c.centre.transpose() << " m, size " << c.size.transpose()
              << " m, yaw " << to_degrees(c.yaw) << " deg, frame " << c.frame << "\n";
  }
}

void describe_map(const std::filesystem::path& file) {
  const LoadedMap map = load_map(file);
  std::size_t surface_blocks = 0;
  for (std::size_t i = 0; i < map.volume->size(); ++i) surface_blocks += map.volume->block(i).surface ? 1 : 0;
  std::cout << "map: voxels of " << map.volume->voxel_m() << " m, " << map.volume->size() << " blocks of 8 x 8 x 8, " << surface_blocks
            << " with a surface, " << map.volume->bytes() / (1 << 20) << " MB\n";
  std::vector<ListedObject> objects;
  for (const MappedObject& object : map.objects) objects.push_back({object.id, object.class_name, object.cuboid, 1.0, 1.0});
  describe_objects(objects);
}

// What `map` makes of a laser log: a trajectory and nothing else.
bool is_laser_map(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "map.json") && std::filesystem::exists(folder / "trajectory.tum") &&
         !std::filesystem::exists(folder / "cuboids.json");
}

void describe_laser_map(const std::filesystem::path& folder) {
  const std::vector<StampedPose> poses = read_trajectory(folder / "trajectory.tum").poses;
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) length_m += (poses[i].X_WB.translation() - poses[i - 1].X_WB.translation()).norm();
  std::cout << "map of a laser log: " << poses.size() << " poses of the laser in " << to_seconds(poses.back().stamp - poses.front().stamp)
            << " s, " << length_m << " m long; no objects, for it had no pictures\n";
}

// What the scans of a recording have in common.
struct LaserFacts {
  std::size_t beams = 0, readings = 0, valid = 0;
  double field_deg = 0.0, range_max = 0.0;

  void add(const LaserScan& scan) {
    beams = std::max(beams, scan.ranges.size());
    if (!scan.ranges.empty()) {
      field_deg = std::max(field_deg, to_degrees(scan.angle_increment) * static_cast<double>(scan.ranges.size() - 1));
    }
    range_max = std::max(range_max, scan.range_max);
    readings += scan.ranges.size();
    valid += static_cast<std::size_t>(std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float range) { return range > 0.0f; }));
  }
  std::string text() const {
    const double share = readings > 0 ? 100.0 * static_cast<double>(valid) / static_cast<double>(readings) : 0.0;
    std::ostringstream out;
    out << beams << " beams over " << field_deg << " deg, up to " << range_max << " m, " << std::round(share) << " % of the readings valid";
    return out.str();
  }
};

void describe_recording(const std::filesystem::path& folder, const RecordingConfig& config) {
  const auto stream = open_recording(folder, config);
  const StreamInfo& info = stream->info();
  std::cout << "recording: " << info.source << "\n";
  for (const auto& [name, camera] : info.cameras) {
    const Intrinsics& k = camera.intrinsics;
    std::cout << "  camera " << name << ": " << k.width << " x " << k.height << " pixels, fx " << k.fx << " fy " << k.fy << " cx " << k.cx
              << " cy " << k.cy << ", depth " << camera.depth_min_m << " to " << camera.depth_max_m << " m, " << camera.rate_hz << " Hz\n";
    const Eigen::Vector3d p_BC = camera.X_BC.translation(), ahead_B = camera.X_BC.linear().col(2);
    if (!camera.X_BC.isApprox(Pose::Identity())) {
      std::cout << "    at (" << p_BC.x() << ", " << p_BC.y() << ", " << p_BC.z() << ") m on the vehicle, looks "
                << std::round(10.0 * to_degrees(std::atan2(ahead_B.y(), ahead_B.x()))) / 10.0 << " deg to the left and "
                << std::round(10.0 * to_degrees(std::asin(-ahead_B.z()))) / 10.0 << " deg down\n";
      // Its pictures' lower edge is up.
      if (camera.X_BC.linear()(2, 1) > 0.1) std::cout << "    hangs upside down: recording.rotate_deg=180 turns its pictures upright\n";
    }
    if (!camera.native) continue;
    const Intrinsics& own = camera.native->lens.intrinsics();
    std::cout << "    with the depth camera's own images: " << own.width << " x " << own.height << " pixels, fx " << own.fx << " fy "
              << own.fy << "\n";
  }
  int frames = 0, scans = 0, readings = 0;
  std::optional<Stamp> first;
  Stamp last = 0;
  LaserFacts beams;
  while (auto event = stream->next()) {
    // Pictures of the wrong size or kind would else come to light in `map`.
    if (auto* frame = std::get_if<RgbdFrame>(&*event); frame != nullptr && frames == 0) load_pictures(*frame);
    if (const auto* scan = std::get_if<LaserScan>(&*event)) beams.add(*scan);
    last = stamp_of(*event);
    if (!first) first = last;
    frames += std::holds_alternative<RgbdFrame>(*event) ? 1 : 0;
    scans += std::holds_alternative<LaserScan>(*event) ? 1 : 0;
    readings += std::holds_alternative<OdometryReading>(*event) ? 1 : 0;
  }
  for (const auto& [name, laser] : info.lasers) {
    const Eigen::Vector3d p_BL = laser.X_BL.translation();
    std::cout << "  laser " << name << ": " << laser.rate_hz << " Hz, " << beams.text() << ", at (" << p_BL.x() << ", " << p_BL.y() << ", "
              << p_BL.z() << ") m on the vehicle, yaw " << to_degrees(yaw_of(laser.X_BL)) << " deg\n";
  }
  std::cout << "  " << frames << " frames, " << scans << " scans, " << readings << " odometry readings in "
            << (first ? to_seconds(last - *first) : 0.0) << " s\n  poses " << (info.has_recorded_poses ? "recorded" : "not recorded")
            << ", up is " << (info.up_W + Eigen::Vector3d::Zero()).transpose() << ", " << stream->lost_frames()
            << " frames without a pose left out\n";
  for (const std::string& source : stream->sources()) std::cout << "  " << source << "\n";
  for (const std::string& remark : stream->remarks()) std::cout << "  " << remark << "\n";
}

int inspect_noise(const InspectOptions& options) {
  InspectConfig config;
  if (options.keys) {
    std::cout << describe_config([&](Fields& f) { config.visit(f); });
    return 0;
  }
  if (options.frames > 0) config.noise.frames = options.frames;
  if (options.reflectivity > 0.0) config.noise.reflectivity = options.reflectivity;
  apply_settings(options.common.settings(), [&](Fields& f) { config.visit(f); });
  const auto stream = open_recording(options.file, config.recording);
  NoiseSurvey survey;
  {
    Progress progress("noise", options.common.quiet);
    survey = survey_noise(*stream, config.noise,
                          [&](double done) { progress.update(done, "of " + std::to_string(config.noise.frames) + " frames"); });
  }
  if (!options.json.empty()) write_file(options.json, noise_json(survey));
  std::cout << noise_text(survey);
  return 0;
}

int inspect(const InspectOptions& options) {
  options.common.apply();
  const std::filesystem::path file = options.file;
  if (!std::filesystem::exists(file)) throw Error(file, "does not exist; expected a scenario, a model, a recording's folder or a map");
  if (options.noise) return inspect_noise(options);
  const std::string extension = file.extension().string();
  const std::vector<Setting> settings = options.common.settings();
  if (extension == ".yaml" || extension == ".yml") {
    const RunConfig defaults;
    RunConfig config = load_run_config(file, defaults, "", settings);
    if (options.common.seed) config.scenario.seed = *options.common.seed;
    if (options.motion_s) return inspect_motion(config.scenario, *options.motion_s, options.common.quiet);
    std::cout << (options.keys ? describe_config([&](Fields& f) { config.visit(f); }) : describe_scenario(config.scenario));
    if (!options.keys) std::cout << "route: " << to_seconds(RobotMotion(config.scenario.robot).duration()) << " s\n";
    return 0;
  }
  if (options.motion_s) throw Error(file, "has no motion; --motion expects a scenario");
  if (is_laser_map(file)) {
    if (options.keys) throw Error(file, "has no keys; expected a scenario or a recording's folder");
    describe_laser_map(file);
    return 0;
  }
  if (is_recording_file(file) || (std::filesystem::is_directory(file) && !std::filesystem::exists(file / "cuboids.json"))) {
    MapConfig config;
    apply_settings(settings, [&](Fields& f) { config.visit(f); });
    if (options.keys) {
      std::cout << describe_config([&](Fields& f) { config.visit(f); });
    } else {
      describe_recording(file, config.recording);
    }
    return 0;
  }
  if (options.keys) throw Error(file, "has no keys; expected a scenario or a recording's folder");
  if (extension == ".glb" || extension == ".gltf") {
    std::cout << describe_scene(load_gltf(file));
  } else if (extension == ".waretwin") {
    describe_map(file);
  } else if (extension == ".json" || std::filesystem::is_directory(file)) {
    describe_objects(read_object_list(file_or_in_folder(file, "cuboids.json")));
  } else {
    throw Error(file, "is of an unknown kind; expected .yaml, .glb, .gltf, .waretwin, .json, .bag, .log, .log.gz or a recording's folder");
  }
  return 0;
}

}  // namespace

Command add_inspect_command(CLI::App& program) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = program.add_subcommand("inspect", "what is in a scenario, a glTF file, a recording, a laser log or a map");
  command
      ->add_option("FILE", options->file,
                   "scenario, .glb, .gltf, recording's folder, ROS 1 bag, CARMEN log, map.waretwin, cuboids.json or a run's folder")
      ->required();
  command->add_flag("--keys", options->keys, "of a scenario or recording: all configuration keys with type, range, value and meaning");
  command->add_option("--motion", options->motion_s, "of a scenario: runs what moves for S seconds, without sensors, and says how it went")
      ->type_name("S")
      ->check(number_from_to(0.1, 1e5));
  CLI::Option* noise = command->add_flag("--noise", options->noise,
                                         "of a recording: how far the depth camera's readings scatter about planes, by range and angle of "
                                         "incidence, and the laws that describe it");
  command->add_option("--frames", options->frames, "with --noise: how many frames to use, spread evenly (default 60)")
      ->type_name("N")
      ->check(whole_number())
      ->check(CLI::Range(1, 1000))
      ->needs(noise);
  command
      ->add_option("--reflectivity", options->reflectivity,
                   "with --noise: of the typical surface at 850 nm, for the time-of-flight law (default 0.5)")
      ->type_name("SHARE")
      ->check(number_from_to(0.01, 2.0))
      ->needs(noise);
  command->add_option("--json", options->json, "with --noise: writes the figures to a file, too")->type_name("FILE")->needs(noise);
  options->common.add_to(*command);
  command->footer(
      "Examples:\n  waretwin inspect scenes/agiprobot/scenario.yaml\n  waretwin inspect scenes/agiprobot/scenario.yaml --keys\n"
      "  waretwin inspect scenes/warehouse/scenario.yaml --motion 3600\n"
      "  waretwin inspect recordings/office --noise --json noise.json\n"
      "  waretwin inspect logs/freiburg.log.gz\n\n"
      "`waretwin inspect RECORDING --noise --keys` lists the keys for --set of --noise.");
  return {command, [options] { return inspect(*options); }};
}

}  // namespace waretwin
