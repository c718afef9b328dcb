// How a run is made, in the words of the command line and of a suite.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/run/run_config.h"

namespace waretwin {

// The profile's constants with rate and detector. `detector`: yolo, none, a JSON file with boxes, or a model (folder, file or shipped
// name); truth, and nothing, are left to the caller. Throws Error for what is none of these.
MapperConfig chosen_mapper(const std::string& profile, const std::optional<std::string>& detector, std::optional<double> rate_hz);

// The same named in a file: a detector that is a file stands in `folder`; words and shipped models are what they are.
std::optional<std::string> detector_beside(const std::optional<std::string>& named, const std::filesystem::path& folder);

struct RunChoice {
  std::string profile = "best";
  std::optional<std::string> detector;  // also truth; nothing: the shipped model
  std::string poses;                    // empty: as the profile has it; laser, odometry or truth
  std::string depth = "sensor", association = "map";
  std::optional<double> rate_hz;  // nothing: as the profile has it
  int frames = 0;                 // 0: all
  std::string resume;             // a map.waretwin; no key: nothing that a file says over and over
  std::string extrinsics;         // of `calibrate`; no key: `set` names it
  ExternalMapper external_mapper;

  void visit(Fields& f);
};

// All but the scenario.
RunConfig chosen_run(const RunChoice& choice);

// Throws Error where the choice tells another mapper what only ours can be told: a profile, a detector's model, how it localises or
// associates.
void expect_none_of_ours(const RunChoice& choice);

}  // namespace waretwin
