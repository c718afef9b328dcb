// Options of the commands that judge a score.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "core/config.h"
#include "harness/gate/measures.h"

namespace waretwin {

struct GateOptions {
  std::string tolerance_file, junit;

  void add_to(CLI::App& command);
  // Makes the folder of the JUnit file, so that one that cannot be is known before any work.
  void make_ready() const;
  // The usual ones, over them the file's and over those the settings', whose keys all begin with "tolerances.".
  Tolerances tolerances(const std::vector<Setting>& settings) const;
};

// Takes the settings of tolerances out of `settings`.
std::vector<Setting> take_tolerance_settings(std::vector<Setting>& settings);

}  // namespace waretwin
