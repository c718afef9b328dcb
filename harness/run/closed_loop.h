// The closed loop: scenario -> sensor stream -> mapper -> object map -> score.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/digest.h"
#include "harness/pictures/map_pictures.h"
#include "harness/run/mapping.h"
#include "harness/run/run_config.h"
#include "harness/score/run_score.h"

namespace waretwin {

struct ClosedLoopResult {
  MappingResult mapping;
  std::vector<ListedObject> mapped, truth;               // truth with the visible fractions
  std::vector<StampedPose> trajectory, true_trajectory;  // at the same stamps
  std::string detections;                                // DetectionLog::lines; empty without a detector
  std::string truth_frames;                              // a line a mapped frame (truth_frame_line); empty where that is switched off
  std::map<std::string, std::vector<StampedPose>> sensor_poses;  // as SensorPoses::poses
  RunScore score;
};

// Drives the whole route (or simulation.max_frames camera frames) through `scene`, which is config.scenario's (build_scene), and scores the
// map. Throws Error for what the scenario or the configuration lacks; `ready` is called when all that could be refused beforehand was not,
// so that nothing need be written before.
ClosedLoopResult run_closed_loop(const RunConfig& config, const std::shared_ptr<const Scene>& scene,
                                 const std::function<void()>& ready = {},
                                 const std::function<void(double, const ObjectMap&)>& progress = {});

// Objects and trajectory, as any run's digest begins.
void add_to(Digest& digest, const std::vector<ListedObject>& objects, const std::vector<StampedPose>& trajectory);

// Fingerprint of cuboids, trajectory and voxels: equal runs have equal ones, at any number of threads.
std::string digest_of(const ObjectMap& map);

// The mapped objects as the scorer compares them, in order of ids.
std::vector<ListedObject> listed(const ObjectList& objects);

std::vector<StampedPose> stamped(const std::vector<TrajectoryPoint>& trajectory);

// Median, 95th percentile and maximum of every stage.
std::map<std::string, TimingSummary> summarise_stages(const std::vector<FrameRow>& frames);

// The most memory that the process has held so far, in MB of 2^20 bytes.
double peak_rss_mb();

}  // namespace waretwin
