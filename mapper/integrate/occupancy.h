// A plan for navigation: which parts of the floor the volume shows to be free, occupied or unknown for a robot of a given height.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/fields.h"
#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

struct OccupancyConfig {
  double min_z_m = 0.05;
  double max_z_m = 1.5;
  double min_free_share = 0.1;

  void visit(Fields& f) {
    f("min_z_m", min_z_m, "lower end of the band of heights that the robot fills, above the floor's noise", {.min = -1000, .max = 1000});
    f("max_z_m", max_z_m, "upper end of the band", {.min = -1000, .max = 1000});
    f("min_free_share", min_free_share, "share of a cell's band that must be seen free for the cell to count as free",
      {.min = 0, .max = 1});
    if (!(max_z_m > min_z_m)) f.reject("max_z_m", "must lie above min_z_m");
  }
};

struct OccupancyGrid {
  double resolution_m = 0.0;                         // edge of a cell: that of a voxel
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  // lower left corner of cell (0, 0) in the world, metres
  int width = 0, height = 0;                         // cells along x and y
  std::vector<VoxelState> cells;                     // row by row, x fastest, rows upwards in y

  VoxelState at(int x, int y) const {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

// A cell is occupied where any voxel of its column within the band is, else free where at least min_free_share of them are free (and at
// least one), else unknown. The grid covers all blocks that reach into the band; it has no cells when there are none.
OccupancyGrid make_occupancy_grid(const TsdfVolume& volume, const OccupancyConfig& config);

}  // namespace waretwin
