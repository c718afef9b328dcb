// Options that put another mapper in place of ours: of `run`, with and without a suite, and of `study`.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"

namespace waretwin {

struct ExternalOptions {
  std::optional<std::string> command;
  std::string format;
  std::optional<double> timeout_s;
  bool keep_recording = false;

  // `kept`: where a recording stays, for --help. Returns --mapper, which the others need.
  CLI::Option* add_to(CLI::App& app, const std::string& kept);
  // What was given, as settings of external_mapper. Throws Error for an empty command.
  std::vector<Setting> settings() const;
};

}  // namespace waretwin
