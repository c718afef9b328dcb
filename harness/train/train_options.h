// The command line of `waretwin train`, which the program parses and passes on to waretwin-train.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/program/common_options.h"

namespace waretwin {

struct TrainOptions {
  CommonOptions common;
  std::string dataset, out, name = "detector", from;
  bool resume = false;
  std::optional<int> epochs;
  std::optional<double> minutes;

  void add_to(CLI::App& command);
  // The same options as words of a command line.
  std::vector<std::string> arguments() const;
};

}  // namespace waretwin
