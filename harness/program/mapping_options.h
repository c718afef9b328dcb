// Options that `run` and `map` share: the mapper's profile and where each stage's input comes from.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "mapper/mapper_config.h"

namespace waretwin {

struct MappingOptions {
  std::string profile = "best";
  std::optional<std::string> detector;
  std::optional<double> rate_hz;
  int frames = 0;
  std::string resume;
  std::string config_file;

  void add_to(CLI::App& command, const std::string& detector_help);
  // The profile's constants with rate and detector. `truth` and no detector are left to the caller.
  MapperConfig mapper_config() const;
};

}  // namespace waretwin
