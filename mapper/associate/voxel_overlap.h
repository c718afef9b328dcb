// Which labels of the volume a segment of a frame lies on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

struct VoxelOverlap {
  int voxels = 0;                      // that hold a point of the segment
  std::map<std::int32_t, int> labels;  // of these: how many hold each label L(v); voxels without one (0) are not named
};

// Each voxel counts once, however many of the points (metres, W) fall into it, so that counts do not depend on distance or resolution.
VoxelOverlap voxel_overlap(const std::vector<Eigen::Vector3f>& points_W, const TsdfVolume& volume);

// The mapped segment that each segment of a frame is: pairs by falling count of common voxels, then in ascending order; none below
// min_voxels, and each mapped segment goes to one at most. 0 = a segment that was not mapped before.
std::vector<std::int32_t> match_labels(const std::vector<VoxelOverlap>& overlaps, int min_voxels);

}  // namespace waretwin
