// Somebody else's mapper in the loop: a drive recorded, their command run on the recording, and the cuboids that it leaves scored.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/run/external_mapper.h"
#include "harness/run/run_config.h"
#include "harness/run/run_folder.h"
#include "harness/run/shell_command.h"

namespace waretwin {

struct ExternalRunResult {
  ShellResult shell;
  std::vector<std::string> last_words;  // the last lines of its stderr
  std::vector<ListedObject> truth;
  std::string trajectory_problem;  // why its trajectory.tum is not scored; empty: it is, or there is none
  // Nothing where the command failed or was ended.
  std::optional<RunScore> score;
};

// config.external_mapper in the loop. Drives the route through `scene` and leaves in the folder:
//   mapper/recording      what the sensors measured; of the truth only what config.truth_stages asks for: the camera's poses (poses),
//                         boxes.json (detector). Taken away after a success unless keep_recording.
//   mapper/out            what the command wrote: cuboids.json is scored, and trajectory.tum (X_WB in the hall's world) where it is there
//   mapper/stdout.log, mapper/stderr.log
//   cuboids.json, trajectory.tum (copies), truth.json, trajectory_truth.tum, table6.md, topdown.png, report.html, score.json (last)
// The truth is written after the command has ended; nothing else keeps it from the hall's own files. Frames that config.mapper.rate_hz
// drops are not recorded; everything else of config.mapper has no meaning here. Throws Error for a command without {recording} or {out},
// for a format that cannot carry what is asked for, and where the command ended well but left no cuboids.json that can be read. `ready` and
// `progress` (share of the drive, words) as in run_closed_loop.
ExternalRunResult run_external(const RunConfig& config, const std::shared_ptr<const Scene>& scene, const std::function<RunFolder&()>& ready,
                               const std::function<void(double, const std::string&)>& progress);

}  // namespace waretwin
