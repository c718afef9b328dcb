#include "mapper/associate/voxel_overlap.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <tuple>

namespace waretwin {

VoxelOverlap voxel_overlap(const std::vector<Eigen::Vector3f>& points_W, const TsdfVolume& volume) {
  std::vector<std::array<int, 3>> voxels;
  for (const Eigen::Vector3f& p_W : points_W) {
    const Eigen::Vector3i voxel = volume.voxel_at(p_W.cast<double>());
    const std::array<int, 3> key = {voxel.x(), voxel.y(), voxel.z()};
    // Neighbouring pixels mostly fall into one voxel: there is little left to sort.
    if (voxels.empty() || voxels.back() != key) voxels.push_back(key);
  }
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  VoxelOverlap overlap;
  overlap.voxels = static_cast<int>(voxels.size());
  for (const auto& [x, y, z] : voxels) {
    const std::int32_t label = volume.label({x, y, z});
    if (label != 0) ++overlap.labels[label];
  }
  return overlap;
}

std::vector<std::int32_t> match_labels(const std::vector<VoxelOverlap>& overlaps, int min_voxels) {
  std::vector<std::tuple<int, std::size_t, std::int32_t>> pairs;  // -voxels, segment, label
  for (std::size_t i = 0; i < overlaps.size(); ++i) {
    for (const auto& [label, voxels] : overlaps[i].labels) {
      if (voxels >= min_voxels) pairs.emplace_back(-voxels, i, label);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::int32_t> matched(overlaps.size(), 0);
  std::set<std::int32_t> used;
  for (const auto& [negative, i, label] : pairs) {
    if (matched[i] == 0 && used.insert(label).second) matched[i] = label;
  }
  return matched;
}

}  // namespace waretwin
