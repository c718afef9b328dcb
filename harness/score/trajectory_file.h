// Trajectories as text: TUM (stamp x y z qx qy qz qw) and KITTI (a 3x4 matrix a row, no stamps).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"

namespace waretwin {

struct StampedPose {
  Stamp stamp = 0;
  Pose X_WB = Pose::Identity();
};

struct Trajectory {
  std::vector<StampedPose> poses;  // in order of stamps; KITTI: row i has stamp i
  bool has_stamps = true;
};

// Tells the two forms apart by the numbers a row (8 or 12). Lines that start with # and empty lines are left out. Throws Error with file
// and line for a wrong count, text that is not a number, a zero quaternion, stamps that go back, or a file without poses.
Trajectory read_trajectory(const std::filesystem::path& file);

// TUM text; stamps in seconds with nine decimals, so that they come back exactly.
std::string tum_text(const std::vector<StampedPose>& poses);

}  // namespace waretwin
