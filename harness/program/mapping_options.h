// Options that `run` and `map` share: the mapper's profile and where each stage's input comes from.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace waretwin {

struct MappingOptions {
  std::string profile = "best";
  std::optional<std::string> detector;
  std::optional<double> rate_hz;
  int frames = 0;
  std::string resume;
  std::string extrinsics;
  std::string config_file;

  void add_to(CLI::App& command, const std::string& detector_help);
};

}  // namespace waretwin
