// Everything that a closed-loop run depends on, as one configuration tree: the scenario's own keys at the top, the rest in groups.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "harness/run/detection_log.h"
#include "harness/run/external_mapper.h"
#include "harness/score/object_score.h"
#include "harness/truth/truth_detector.h"
#include "harness/truth/truth_frames.h"
#include "mapper/mapper_config.h"
#include "mapper/output/output_config.h"
#include "scenes/scenario.h"
#include "sensors/recordings/ros_bag_config.h"
#include "sim/simulated_stream.h"

namespace waretwin {

// Stages of the mapper that the truth stands in for. True depth is simulation.truth_depth.
struct TruthStages {
  bool detector = false;
  bool poses = false;
  bool association = false;
  void visit(Fields& f);
};

// What a run measures beside the map, for its score and report. Each takes time that a run of many need not spend.
struct RunExtras {
  bool pictures = true;       // of frames
  bool depth = true;          // RunScore::depth
  bool surface = true;        // RunScore::surface
  bool visible_share = true;  // of each true object; without it all are taken for seen
  void visit(Fields& f);
};

struct RunConfig {
  RunConfig() { mapper.detector = "yolo"; }  // unless told otherwise no truth is in the loop

  Scenario scenario;
  MapperConfig mapper;
  SimulationConfig simulation;
  TruthStages truth_stages;
  TruthDetectorConfig truth_detector;
  TruthFramesConfig truth_frames;
  DetectionLogConfig detection_score;
  ScoringRules score;
  RunExtras extras;
  OutputConfig output;
  RosBagFormat bag;
  ExternalMapper external_mapper;
  std::string resume;      // the map.waretwin to go on from; empty: a new map
  std::string extrinsics;  // of `calibrate`: where the mapper takes the camera to sit; empty: where its bracket is drawn

  void visit(Fields& f);
};

// Reads a scenario; then what `config` (a run's config.yaml or a part of one; empty: none) says, then the settings, each over the whole
// tree. `base` holds everything but the scenario. Throws Error for a key that the tree does not have, naming the nearest one.
RunConfig load_run_config(const std::filesystem::path& scenario, RunConfig base, const std::filesystem::path& config,
                          const std::vector<Setting>& settings);

// The resolved configuration as YAML, with the program's version: config.yaml.
std::string resolved_config(const VisitFunction& visit, const std::string& source);
// Takes such a file back, or a part of one: keys that it leaves out keep their values.
void read_resolved_config(const std::filesystem::path& file, const VisitFunction& visit);

}  // namespace waretwin
