// The map's volume: a truncated signed distance field in hashed blocks of 8 x 8 x 8 voxels, each voxel with colour and label counts.
//
// Curless and Levoy 1996 for the distances, Oleynikova et al. 2017 (Voxblox) for the blocks, the paper's section 3.4 with eqs. (6) and
// (7) for the labels.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace waretwin {

class TsdfVolume;

}  // namespace waretwin
