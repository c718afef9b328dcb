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
  std::string cpu;                            // cpu_identity() of where it was driven
  std::vector<std::string> problems;          // marks missed, what is worse than the baseline, what the vehicle touched; or how another
                                              // mapper failed
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

struct SuiteHooks {
  std::function<void()> check;  // often; may throw to stop: what is done stays, and the run under way is not done
  std::function<void(const SuiteProgress&)> progress;
};

struct SuiteSummary {
  std::string name;
  std::vector<SuiteOutcome> outcomes;  // of all runs; empty where other shards' are missing
  std::vector<std::string> missing;    // runs that other shards have not made yet
  int kinds_of_cpu = 1;                // on which they were made
  int found = 0;                       // runs of this shard that were there already
  int found_unwatched = 0;             // of those, another mapper's that names no files (external_mapper.depends): it may be a new one
};

// Drives this shard's runs, each into OUT/NAME as `waretwin run` does, and writes OUT/suite.json, suite.md and junit.xml where it was the
// last part. A run that is there already, made by the same program on the same kind of CPU of the same scenario and configuration, is not
// driven again; one that could not be driven, or whose mapper failed, is. Files that the suite names are read before the first drive: what
// is wrong with them is an Error that names the run. What goes wrong later is that run's outcome.
SuiteSummary run_suite(const SuiteRequest& request, const SuiteHooks& hooks = {});

}  // namespace waretwin
