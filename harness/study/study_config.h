// A study: what of a vehicle varies, over which halls and seeds, and what is judged.
//
//   study:
//     name: height-and-pitch
//     halls:
//       agiprobot: {scenario: ../scenario.yaml}
//     seeds: [1, 2]
//     run: {detector: truth, rate_hz: 2, set: [simulation.colour=false]}
//     vary:
//       height: {key: sensors.cameras.camera.mount.z_m, from: 0.8, to: 1.6, steps: 5}
//       pitch: {key: sensors.cameras.camera.mount.pitch_deg, values: [30, 45, 60]}
//     constraints: [height < 1.6]
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/fields.h"
#include "harness/generate/drawn_hall.h"
#include "harness/run/run_choice.h"

namespace waretwin {

// One thing that varies: a configuration key with the values that it takes.
struct Factor {
  std::string key;
  std::vector<std::string> also;    // other keys that take the same value
  std::vector<std::string> values;  // numbers or words; of a list, side by side with the other factors' values
  std::optional<double> from, to;   // or a range, ends included
  int steps = 5;                    // of the range in a grid
  double multiple_of = 0.0;         // what values of the range are rounded to; 0: a thousandth of the range's order of magnitude
  std::string baseline;             // empty: as the halls' scenarios have it

  bool is_range() const { return from.has_value(); }
  void visit(Fields& f);
};

struct StudyHall {
  std::string scenario;  // from the study's folder; empty: `generate`
  DrawnHall generate;
  void visit(Fields& f);
};

// How every hall is driven and mapped.
struct StudyRun {
  RunChoice choice;
  std::vector<std::string> set;  // key=value, for all candidates, before what varies
  void visit(Fields& f);
};

// Choosing by coverage alone, before anything is mapped.
struct ScreenConfig {
  int keep = 0;  // candidates that are mapped beside the baseline; 0: all
  std::string by = "object_coverage";
  void visit(Fields& f);
};

// What coverage and blind zones mean. They say nothing of one mount alone, so that all mounts are measured by the same.
struct CoverageConfig {
  double floor_spacing_m = 0.1;                          // of the points on the floor
  int points_per_object = 1000;                          // on its surface
  double place_spacing_m = 0.5;                          // of the places where a camera might look from
  std::vector<double> heights_m = {0.5, 1.0, 1.5, 2.0};  // at which it might
  double least_m = 0.3, reach_m = 4.0;                   // straight-line distances at which it might see
  double rate_hz = 2.0;                                  // looks a second along the route
  double blind_radius_m = 2.0;                           // around the vehicle's outline
  void visit(Fields& f);
};

struct JudgeConfig {
  std::vector<std::string> measures = {"recall",     "precision",         "mean_iou3d",      "mean_e_trans_m", "mean_e_rot_deg",
                                       "ate_rmse_m", "unlocalised_share", "object_coverage", "floor_coverage", "blind_floor",
                                       "route_s"};
  std::string best_by = "mean_iou3d";
  std::vector<std::string> pareto = {"mean_iou3d", "floor_coverage"};
  double confidence = 0.95;
  void visit(Fields& f);
};

struct StudyConfig {
  std::string name = "study";
  std::string description;
  std::map<std::string, StudyHall> halls;
  std::vector<double> seeds = {1};
  std::string vehicle;        // part of a configuration laid over every hall's, from the study's folder: more cameras, other lasers
  std::string vehicle_model;  // glTF of the vehicle, from the study's folder; empty: as the halls' scenarios have it
  StudyRun run;
  std::map<std::string, Factor> vary;  // by names for tables
  std::string design = "grid";         // grid, list, random, sobol
  int points = 32;                     // random, sobol: candidates beside the baseline
  std::uint64_t design_seed = 1;       // random
  std::vector<std::string> constraints;
  ScreenConfig screen;
  CoverageConfig coverage;
  JudgeConfig judge;
  int coverage_maps = 20;  // as pictures, of the best candidates; the baseline has one in any case

  void visit(Fields& f);
};

// Throws Error for what the file cannot say: no hall, nothing that varies, values that do not fit the design, names of measures that there
// are none of.
StudyConfig read_study(const std::filesystem::path& file);

}  // namespace waretwin
