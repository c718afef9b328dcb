// Options that every command takes, and what a command is made of.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"

namespace waretwin {

// Checks for CLI11 whose message says what was expected. CLI11's own let NaN pass, wrap negative numbers and print limits with 300 digits.
CLI::Validator number_from_to(double least, double most);
CLI::Validator whole_number();  // 0 to 2^64 - 1

struct CommonOptions {
  std::optional<std::uint64_t> seed;
  int threads = 0;
  std::vector<std::string> set;
  bool quiet = false;

  void add_to(CLI::App& command);
  // Takes effect: number of threads, how much is logged.
  void apply() const;
  // The --set values, in order.
  std::vector<Setting> settings() const;
};

// Adds a command to the program. `run` is called after parsing and returns the exit code.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

Command add_run_command(CLI::App& program);
Command add_map_command(CLI::App& program);
Command add_record_command(CLI::App& program);
Command add_score_command(CLI::App& program);
Command add_render_command(CLI::App& program);
Command add_inspect_command(CLI::App& program);
Command add_generate_command(CLI::App& program);
Command add_dataset_command(CLI::App& program);
Command add_detect_command(CLI::App& program);
Command add_train_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_study_command(CLI::App& program);
Command add_report_command(CLI::App& program);
Command add_calibrate_command(CLI::App& program);

}  // namespace waretwin
