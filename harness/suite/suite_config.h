// A suite: runs with pass marks, that a change must get through.
//
//   suite:
//     name: smoke
//     runs:
//       cell:
//         generate: {style: cell, seed: 3}
//         detector: truth
//         set: [sensors.cameras.camera.rate_hz=1]
//         pass: {recall: 1, mean_iou3d: 0.9, ate_rmse_m: 0.01}
//       hall:
//         scenario: hall/scenario.yaml
//         baseline: baselines/hall.json
//     external_mapper: {command: "my_mapper {recording} {out}"}   # in place of ours, in every run that names no other
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/gate/measures.h"
#include "harness/generate/drawn_hall.h"
#include "harness/run/run_choice.h"

namespace waretwin {

struct SuiteRun {
  std::string scenario;  // as the file names it; empty: `generate`
  DrawnHall generate;
  RunChoice choice;
  std::string config;            // a run's config.yaml or a part of one
  std::vector<std::string> set;  // key=value
  std::string baseline;          // score.json; empty: none
  PassMarks pass;

  void visit(Fields& f);
};

struct SuiteConfig {
  std::string name = "suite";
  std::map<std::string, SuiteRun> runs;  // by names, which become folders
  Tolerances tolerances;                 // against baselines
  ExternalMapper external_mapper;        // what each run's has where the run itself says nothing

  void visit(Fields& f);
};

// Throws Error for what the file cannot say, names of runs that are no folder's, and a suite without runs.
SuiteConfig read_suite(const std::filesystem::path& file);

}  // namespace waretwin
