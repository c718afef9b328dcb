// `waretwin study`: candidates of a vehicle's sensors driven through the same halls with the same seeds, and compared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "harness/study/study_results.h"
#include "harness/study/study_setup.h"
#include "harness/units/units.h"

namespace waretwin {

struct StudyRequest {
  std::filesystem::path file;
  std::vector<Setting> settings;      // for every run, before what varies; study.KEY changes the study itself
  std::optional<std::uint64_t> seed;  // in place of the first of the study's seeds; the others follow it
  std::filesystem::path out;
  Shard shard;
  bool merge_only = false;     // drives nothing
  bool coverage_only = false;  // maps nothing
  int jobs = 0;                // drives at a time, each on one thread; 0: as many as there are threads and memory, with another mapper one
};

struct StudyProgress {
  std::string stage;  // coverage, runs
  std::string what;   // "c012 in agiprobot, seed 1"
  int number = 0, of = 0;
  double share = 0.0;  // of this stage
};

struct StudyHooks {
  std::function<void()> check;  // often; may throw to stop: what is done stays, and what is under way is not done
  std::function<void(const StudyProgress&)> progress;
};

struct StudySummary {
  StudyConfig study;
  std::optional<StudyResults> results;  // nothing where other shards' runs are missing
  std::string verdict;                  // which is the best and by how much, or why there is none
  std::filesystem::path folder;         // of the results: OUT, of coverage alone OUT/screening
  int runs = 0, missing = 0;            // of all shards
  int found = 0;                        // of this shard, there already
  int found_unwatched = 0;              // of those, another mapper's that names no files (external_mapper.depends): it may be a new one
  int kinds_of_cpu = 1;
};

// Measures the coverage of every candidate, drives this shard's share of the runs that follow, and, where it was the last part, writes
// results.json, results.csv, runs.csv, study.md, best/, plots/ and coverage/ into OUT (with coverage alone: into OUT/screening). What units
// were found there, made by the same program of the same scenario and configuration, is not done again. Throws Error for what is wrong with
// the study before anything is driven; what goes wrong in a drive stands with its candidate. What another mapper leaves is put into
// OUT/drives/CANDIDATE-HALL-SEED where it fails (the recording of the first failure alone), and where external_mapper.keep_recording says
// so; what drives of another study left there is taken away. Where all have one command, and the shell cannot start it in the first drive,
// Error.
StudySummary run_study(const StudyRequest& request, const StudyHooks& hooks = {});

}  // namespace waretwin
