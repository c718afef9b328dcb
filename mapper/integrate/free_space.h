// What one frame saw to be free: voxels between the camera and the truncation band of the surfaces.
//
// Voxblox casts every ray through all the free space before its surface and pulls the distances there towards +truncation; that is
// most of its time, and at the rims of objects it wears surfaces away. Here a voxel is projected into the depth image instead, and
// counts as seen through when all valid depths in its footprint lie more than a truncation distance behind it, and at least half of
// the footprint is valid. So no frame clears a voxel that it sees a surface in, grazing rays included. The footprint is looked up in a
// pyramid of smallest and largest depths, and whole blocks are decided at once where they can be.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/pose.h"
#include "mapper/integrate/tsdf_volume.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin {

struct FreeBlock {
  Eigen::Vector3i index;
  std::array<std::uint64_t, 8> voxels;  // bit y * 8 + x of word z: seen through
};

// Blocks with at least one voxel seen through, ascending by (x, y, z). Looks no farther than config.max_depth_m.
std::vector<FreeBlock> find_free_space(const RgbdFrame& frame, const Intrinsics& intrinsics, const Pose& X_WC, const TsdfConfig& config);

}  // namespace waretwin
