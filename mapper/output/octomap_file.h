// The volume as an OctoMap (Hornung et al. 2013), for planners that read one (MoveIt, octomap_server). An optional part: it needs
// liboctomap-dev when the program is built.
#pragma once

#include <filesystem>

#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

// False where the program was built without OctoMap.
bool octomap_available();

// A binary OcTree (.bt) in the volume's world, metres, its finest nodes the volume's voxels: occupied, free, or not in the tree where
// VoxelState is unknown. Equal neighbours are one larger node. An empty volume gives an empty tree.
// OctoMap's keys reach 32768 voxels to each side of the world's origin (655 m at 2 cm); what lies farther out is left out.
// Throws Error where the file cannot be written, and, naming the package, where the program was built without OctoMap.
void write_octomap(const std::filesystem::path& file, const TsdfVolume& volume);

}  // namespace waretwin
