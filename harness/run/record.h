// A simulated drive as a recording on disk.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "harness/score/cuboid_file.h"
#include "harness/score/trajectory_file.h"
#include "harness/truth/truth_detector.h"
#include "scenes/scenario.h"
#include "sensors/recordings/ros_bag_config.h"
#include "sim/motion/hall_motion.h"
#include "sim/simulated_stream.h"

namespace waretwin {

// What a recording depends on, under the same keys as in RunConfig.
struct RecordConfig {
  Scenario scenario;
  SimulationConfig simulation;
  TruthDetectorConfig truth_detector;
  RosBagFormat bag;
  void visit(Fields& f);
};

// Reads a scenario, then the settings over the whole tree.
RecordConfig load_record_config(const std::filesystem::path& scenario, const SimulationConfig& simulation,
                                const std::vector<Setting>& settings);

// What of a drive is written.
struct RecordPlan {
  std::string format = "tum";  // one of recording_formats() (sensors/recordings/recording_writer.h)
  // The truth beside the recording, for scoring and for nobody who maps:
  //   truth.json            true cuboids with the share that the recorded frames saw
  //   truth_boxes.json      the true boxes of every frame, as `waretwin map --detector` takes them: what `run --detector truth` maps with
  //   trajectory_truth.tum  the true X_WB at every event
  //   NAME.xml              (scenenn; NAME is the folder's) the true cuboids as SceneNN annotates them
  //   config.yaml           scenario and simulation, resolved; `waretwin run SCENARIO --config` takes it
  bool truth_beside = true;
  // The camera's true poses as the recorded ones, in formats that have a place for them; `map` takes them with --poses recorded, and where
  // there is no laser.
  bool true_poses = false;
  bool true_boxes = false;    // boxes.json, as truth_boxes.json, though there is no truth beside
  double rate_hz = 0.0;       // frames recorded a second, those in between are dropped; 0: every frame
  bool visible_share = true;  // how much of each true object the frames saw is measured; without it all are taken for seen
};
// As `waretwin record` writes a format: those that are published with the camera's poses get the true ones.
RecordPlan record_plan(const std::string& format);

struct RecordSummary {
  int frames = 0, scans = 0, readings = 0;  // camera frames that were written, laser scans, odometry readings
  double duration_s = 0.0;                  // from the first event to the last
};

struct RecordedDrive {
  RecordSummary summary;
  std::vector<ListedObject> truth;           // with the share that the recorded frames saw
  std::vector<StampedPose> true_trajectory;  // X_WB at every event
  MotionReport motion;
};

// Drives the whole route (or simulation.max_frames camera frames) through `scene`, which is config.scenario's (build_scene), and writes
// what the sensors measured into `folder`. The folder appears when all is written. An earlier recording of ours is then replaced; throws
// Error for a folder that holds anything else, for what the layout cannot hold, and where the disk is full. `progress`, after each event:
// share of the drive that is done, and the summary so far; what it throws ends the recording and leaves nothing behind.
RecordedDrive record_drive(const RecordConfig& config, const std::shared_ptr<const Scene>& scene, const RecordPlan& plan,
                           const std::filesystem::path& folder, const std::string& source,
                           const std::function<void(double, const RecordSummary&)>& progress = {});

}  // namespace waretwin
