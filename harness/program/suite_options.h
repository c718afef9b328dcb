// `waretwin run --suite`.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "harness/program/common_options.h"

namespace waretwin {

struct SuiteOptions {
  std::string suite, shard;
  bool merge = false;

  void add_to(CLI::App& command);
};

// `before`: settings for every run, before those of `common`. 0 where every run passed or other shards' are missing, 1 where one did not,
// 2 where one could not be driven.
int run_suite_by(const SuiteOptions& options, const CommonOptions& common, const std::vector<Setting>& before, const std::string& out);

}  // namespace waretwin
