// The points of one frame, grouped by the voxel they fall into: the first half of grouped ray casting.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/pose.h"
#include "mapper/integrate/tsdf_config.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin {

struct PointGroup {
  Eigen::Vector3i voxel;                    // of the volume
  Eigen::Vector3f mean;                     // weighted mean position in metres from the camera's centre, axes of the world
  float weight = 0.0f;                      // sum over the group's points
  std::array<std::uint8_t, 3> colour = {};  // mean; red, green, blue
  std::int32_t label = 0;                   // of most of its points; of equally many the smallest
  std::uint32_t points = 0;
};

// Groups in ascending order of their blocks and, within a block, of their voxels. Pixels without depth, or with depth beyond
// config.max_depth_m, are left out; `labels` holds one id per pixel or is empty.
std::vector<PointGroup> group_points(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels,
                                     const Pose& X_WC, const TsdfConfig& config);

}  // namespace waretwin
