#include "harness/program/mapping_options.h"

#include <CLI/CLI.hpp>

#include "harness/program/common_options.h"

namespace waretwin {

void MappingOptions::add_to(CLI::App& command, const std::string& detector_help) {
  command
      .add_option("--profile", profile,
                  "best: ours; paper: the published method with its constants; voxbloxpp: geometric segments in the volume, which the "
                  "paper compares with")
      ->capture_default_str()
      ->check(CLI::IsMember({"best", "paper", "voxbloxpp"}));
  command.add_option("--detector", detector, detector_help)->type_name("WHAT");
  command
      .add_option("--rate", rate_hz,
                  "frames mapped a second, those in between are dropped; 0 = every frame (default: 1 for paper and voxbloxpp, 0 for best)")
      ->type_name("HZ")
      ->check(number_from_to(0.0, 1000.0));
  command.add_option("--frames", frames, "stops after N camera frames (0: all)")
      ->type_name("N")
      ->check(whole_number())
      ->check(CLI::Range(0, 1000000000));
  command
      .add_option("--resume", resume, "an earlier run's map.waretwin, to go on from: objects keep their ids; poses must be in its world")
      ->type_name("MAP");
  command
      .add_option("--extrinsics", extrinsics,
                  "a calibration (waretwin calibrate): the mapper takes the camera to sit where it says; nothing else changes")
      ->type_name("FILE");
  CLI::Option* from_file =
      command
          .add_option("--config", config_file,
                      "an earlier run's config.yaml, or a part of one: repeats it; --seed and --set still change single values")
          ->type_name("FILE");
  // The file settles what these would.
  for (const char* settled : {"--profile", "--detector", "--rate", "--frames", "--resume", "--extrinsics"}) from_file->excludes(settled);
}

}  // namespace waretwin
