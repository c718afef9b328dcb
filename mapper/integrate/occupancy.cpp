#include "mapper/integrate/occupancy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace waretwin {

OccupancyGrid make_occupancy_grid(const TsdfVolume& volume, const OccupancyConfig& config) {
  OccupancyGrid grid;
  grid.resolution_m = volume.voxel_m();
  // Voxels whose centres lie in the band.
  const int first = static_cast<int>(std::ceil(config.min_z_m / volume.voxel_m() - 0.5));
  const int last = static_cast<int>(std::floor(config.max_z_m / volume.voxel_m() - 0.5));
  if (last < first) return grid;

  constexpr int kFar = std::numeric_limits<int>::max();
  int x0 = kFar, y0 = kFar, x1 = -kFar, y1 = -kFar;
  std::vector<std::size_t> in_band;
  for (const std::size_t b : volume.sorted_positions()) {
    const Eigen::Vector3i& index = volume.block(b).index;
    if (8 * index.z() > last || 8 * index.z() + 7 < first) continue;
    in_band.push_back(b);
    x0 = std::min(x0, index.x());
    y0 = std::min(y0, index.y());
    x1 = std::max(x1, index.x());
    y1 = std::max(y1, index.y());
  }
  if (in_band.empty()) return grid;
  grid.origin = Eigen::Vector2d(8.0 * x0, 8.0 * y0) * volume.voxel_m();
  grid.width = 8 * (x1 - x0 + 1);
  grid.height = 8 * (y1 - y0 + 1);
  grid.cells.assign(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height), VoxelState::unknown);

  // Blocks come sorted by x and y: those of one column of blocks stand together.
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < in_band.size(); ++i) {
    const auto column = [&](std::size_t k) { return volume.block(in_band[k]).index.head<2>().eval(); };
    if (i == 0 || column(i) != column(i - 1)) starts.push_back(i);
  }
  starts.push_back(in_band.size());
  const double wanted = std::max(1.0, config.min_free_share * (last - first + 1));
  parallel_for(starts.size() - 1, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      std::array<int, 64> free{}, occupied{};
      for (std::size_t i = starts[c]; i < starts[c + 1]; ++i) {
        const TsdfBlock& block = volume.block(in_band[i]);
        for (int z = 0; z < 8; ++z) {
          const int height = 8 * block.index.z() + z;
          if (height < first || height > last) continue;
          for (int xy = 0; xy < 64; ++xy) {
            const VoxelState state = volume.state(block, 64 * z + xy);
            free[static_cast<std::size_t>(xy)] += state == VoxelState::free;
            occupied[static_cast<std::size_t>(xy)] += state == VoxelState::occupied;
          }
        }
      }
      const Eigen::Vector3i& index = volume.block(in_band[starts[c]]).index;
      for (int xy = 0; xy < 64; ++xy) {
        const auto i = static_cast<std::size_t>(xy);
        const int x = 8 * (index.x() - x0) + xy % 8, y = 8 * (index.y() - y0) + xy / 8;
        grid.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(x)] =
            occupied[i] > 0     ? VoxelState::occupied
            : free[i] >= wanted ? VoxelState::free
                                : VoxelState::unknown;
      }
    }
  });
  return grid;
}

}  // namespace waretwin
