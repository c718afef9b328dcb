// Straight pieces of a scan, one of which is the board.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "harness/calibrate/still_poses.h"

namespace waretwin {

// A beam's mean that lies on the board, or may.
struct LaserPoint {
  double angle = 0.0;    // radians, in the laser's frame
  double range_m = 0.0;  // as it reads
  double sigma_m = 0.0;  // of the mean, by chance alone
  Eigen::Vector3d direction_L() const { return {std::cos(angle), std::sin(angle), 0.0}; }
  Eigen::Vector3d p_L() const { return range_m * direction_L(); }
};

// A line has at least this many beams.
constexpr int kLeastPoints = 8;

// Read something in at least half of the scans.
bool steady(const BeamMean& beam, int scans);

// With the scatter that most of these beams have: that of one alone is known badly.
std::vector<LaserPoint> laser_points(const std::vector<BeamMean>& beams);

// In the plane of the laser, metres.
struct ScanLine {
  std::vector<LaserPoint> points;
  Eigen::Vector2d middle_L = Eigen::Vector2d::Zero(), direction_L = Eigen::Vector2d::UnitX();  // direction: of length 1, either way
  double length_m = 0.0;
};

// All of a pose, in order of their beams: neighbours without a gap in range, within 2 cm (rms) of a line, without two beams at either end,
// where the spot is half beside what it is.
std::vector<ScanLine> scan_lines(const StillPose& pose);

}  // namespace waretwin
