// The volume's surface as points by label: what there is of a mapped segment to put a box around.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <vector>

#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

// How far from a pixel's point lie the voxels that count its label, at most; metres.
double label_reach_m(const TsdfConfig& config);

// One point (metres, W) where the distance between two neighbouring voxels passes 0, for the labels asked for: the label is L(v) of the
// voxel nearer to the point. Ascending by blocks and voxels; distances farther apart than the truncation are where two views met, and make
// none (as in mesher.h). The same at any number of threads. A label is sought only in the blocks
// that its box (metres, W) touches; a point lies in the block of the lower one of its two voxels.
std::map<std::int32_t, std::vector<Eigen::Vector3f>> label_surface(const TsdfVolume& volume,
                                                                   const std::map<std::int32_t, Eigen::AlignedBox3d>& labels);

}  // namespace waretwin
