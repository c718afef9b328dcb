// The laser-to-camera calibration: a stream in which a checkerboard is held still in several poses, to the camera's mounting with its
// covariance. Knows nothing of any truth: a recording of a real robot does as well. calibrate() is the method on one screen.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/calibrate/lens_estimate.h"
#include "harness/calibrate/refine.h"
#include "harness/calibrate/still_poses.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

struct CalibrateConfig {
  std::string camera, laser;  // names in the stream; empty: the only one
  CheckerBoard board;
  StillConfig still;
  GuessGate guess;
  RefineConfig refine;
  LensConfig lens;
  int least_poses = 5;             // what the closed form needs
  double least_angle_deg = 5.0;    // see expect_determined
  double largest_corner_px = 2.0;  // a pose whose corners are farther off their board (rms) was none
  void visit(Fields& f);
};

// What became of one still pose.
struct PoseReport {
  double at_s = 0.0;  // first frame, from the stream's first event
  int frames = 0, scans = 0, points = 0;
  double corner_rms_px = 0.0, point_rms_m = 0.0;
  std::string unused;  // why; empty: used
};

struct Calibration {
  std::string camera, laser;
  Pose X_BC_given = Pose::Identity();  // what the stream said
  Pose X_BL = Pose::Identity();        // kept: localisation is by the laser, so it is the camera that is moved
  Intrinsics given;
  Refined found;
  std::vector<PoseReport> poses;
  std::optional<LensEstimate> lens;
  int frames = 0, frames_with_board = 0, used_poses = 0;
};

// Reads the stream to its end. Throws Error where a sensor is missing or named wrongly, no board was seen, or its poses do not determine
// the mounting (expect_determined).
Calibration calibrate(SensorStream& stream, const CalibrateConfig& config, const std::function<void(double, int)>& progress = {});

// The second half: from what was seen. `still` is of one camera and laser; `info` names them.
Calibration calibrate(const std::vector<StillPose>& still, const StreamInfo& info, const CalibrateConfig& config);

}  // namespace waretwin
