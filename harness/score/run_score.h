// All that score.json says about a run, or about two lists of objects.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/score/depth_quality.h"
#include "harness/score/detection_score.h"
#include "harness/score/explain.h"
#include "harness/score/object_score.h"
#include "harness/score/surface_score.h"
#include "harness/score/trajectory_score.h"
#include "sim/motion/hall_motion.h"

namespace waretwin {

struct TimingSummary {
  double median = 0.0, p95 = 0.0, max = 0.0;  // milliseconds
};

// Median and 95th percentile by linear interpolation between the sorted values; zeros for none.
TimingSummary summarise_timing(std::vector<double> values_ms);

// Compared as they are, and once more after the map was laid over the truth by one planar motion.
struct ComparedLists {
  ObjectListScore plain;
  std::optional<ObjectListScore> aligned;
  std::optional<Pose> X_TM;               // the motion
  std::vector<Explanation> explanations;  // what is wrong with the lists as they are
};
ComparedLists compare_lists(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth,
                            const ScoringRules& rules = {});

struct RunScore {
  std::string scenario, profile;
  std::uint64_t seed = 0;
  std::string digest;
  std::map<std::string, std::string> stages;  // who made what: detector, poses, depth, association
  ComparedLists objects;
  std::optional<TrajectoryScore> trajectory, trajectory_aligned;
  // Of the poses that were asked for while the vehicle moved: share that rest on odometry alone. Nothing where it never moved.
  std::optional<double> unlocalised_share;
  std::optional<DetectionScore> detection;         // the detector in the mapped frames
  std::optional<DepthQuality> depth;               // of the mapped frames
  std::optional<SurfaceScore> surface;             // the mesh against the hall
  std::optional<MotionReport> motion;              // what moved in the hall and what the vehicle touched
  std::map<std::string, TimingSummary> timing_ms;  // simulate, localise, detect, segment, associate, integrate, frame
  int frames_simulated = 0, frames_mapped = 0, frames_dropped = 0, frames_without_pose = 0;
  std::map<std::string, int> rejected;  // reasons why detections came to nothing
  double realtime_factor = 0.0;         // simulated seconds a second of wall time
  double peak_rss_mb = 0.0;
};

}  // namespace waretwin
