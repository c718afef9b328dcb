// Runs of a suite, one after the other or split over processes.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "harness/suite/suite_config.h"
#include "harness/units/units.h"

namespace waretwin {

struct SuiteOutcome {
  std::string run;
  std::string error;                          // why it could not be driven; empty: it was
  std::string digest;                         // of the map
  std::vector<std::string> problems;          // marks missed, what is worse than the baseline, what the vehicle touched
  std::vector<std::optional<double>> values;  // of measures()
  bool passed() const { return error.empty() && problems.empty(); }
};

struct SuiteProgress {
  std::string run;
  int number = 0, of = 0;  // of this shard, from 1
  double share = 0.0;      // of this run
};

struct SuiteRequest {
  std::filesystem::path file;
  std::vector<Setting> settings;  // for every run, after its own
  std::filesystem::path out;
  Shard shard;
  bool merge_only = false;  // drives nothing
};

struct SuiteSummary {
  std::string name;
  std::vector<SuiteOutcome> outcomes;  // of all runs; empty where other shards' are missing
  int missing = 0;                     // runs that other shards have not made yet
  int found = 0;                       // runs of this shard that were there already
};

// Drives this shard's runs, each into OUT/NAME as `waretwin run` does, and writes OUT/suite.json, suite.md and junit.xml where it was the
// last part. A run that OUT/units holds, made by the same program on the same kind of CPU of the same scenario and configuration, is not
// driven again. All that can be refused is refused before the first drive, with an Error that names the run; what goes wrong later is that
// run's outcome.
SuiteSummary run_suite(const SuiteRequest& request, const std::function<void(const SuiteProgress&)>& progress = {});

}  // namespace waretwin
