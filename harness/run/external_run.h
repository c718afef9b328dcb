// Somebody else's mapper in the loop: a drive recorded, their command run on the recording, and the cuboids that it leaves scored.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/run/external_mapper.h"
#include "harness/run/run_config.h"
#include "harness/run/run_folder.h"
#include "harness/run/shell_command.h"
#include "harness/score/run_score.h"
#include "harness/score/trajectory_file.h"

namespace waretwin {

struct ExternalRunResult {
  std::filesystem::path folder;  // of the run, absolute
  double timeout_s = 0.0;
  ShellResult shell;
  std::vector<std::string> last_words;  // the last lines of its stderr
  std::string list_problem;             // why its cuboids.json is not scored though it ended well
  std::string trajectory_problem;       // why its trajectory.tum is not scored, though its list is
  std::vector<ListedObject> truth, mapped;
  std::vector<StampedPose> true_trajectory;
  std::optional<Trajectory> trajectory;
  // Nothing where the command failed, was ended, or left no list that can be read: failure_text.
  std::optional<RunScore> score;
};

// Throws Error for an external_mapper that cannot be run with the rest of the configuration: a command without {recording} or {out}, a
// format that cannot carry what is asked for, files under `depends` that are not there, a map or calibration for our own mapper.
void check_external(const RunConfig& config);

// config.external_mapper in the loop. Drives the route through `scene` and leaves in the folder:
//   mapper/recording      what the sensors measured; of the truth only what config.truth_stages asks for: the camera's poses (poses),
//                         boxes.json (detector)
//   mapper/out            what the command wrote: cuboids.json is scored, and trajectory.tum (X_WB in the hall's world) where it is there
//   mapper/stdout.log, mapper/stderr.log
// The truth is written after the command has ended (write_external); nothing else keeps it from the hall's own files. Frames that
// config.mapper.rate_hz drops are not recorded; everything else of config.mapper has no meaning here. Throws Error as check_external, and
// where the drive cannot be recorded; what the command does wrong is part of the result. `ready` and `progress` (share of the drive, words)
// as in run_closed_loop; what `progress` throws ends the command.
ExternalRunResult run_external(const RunConfig& config, const std::shared_ptr<const Scene>& scene, const std::function<RunFolder&()>& ready,
                               const std::function<void(double, const std::string&)>& progress);

// Why there is no score, in one line of UTF-8 that the same failure makes again, with the command's last word. `shown` stands for the
// run's folder in it.
std::string failure_text(const ExternalRunResult& result, const std::filesystem::path& shown);

// Likewise why trajectory.tum is not scored; empty where it is, or where there is none.
std::string trajectory_text(const ExternalRunResult& result, const std::filesystem::path& shown);

// truth.json and trajectory_truth.tum, and of a score cuboids.json, trajectory.tum (copies), table6.md, topdown.png, report.html and
// score.json (last); the recording is then taken away, unless external_mapper.keep_recording.
void write_external(RunFolder& folder, const RunConfig& config, const ExternalRunResult& result);

// Takes mapper/recording away: a drive takes gigabytes, and of many failures one recording is enough to find the fault by.
void remove_recording(const RunFolder& folder);

}  // namespace waretwin
