// Euclidean signed distances (ESDF) for planners: how far each place is from the nearest obstacle, in all of space, not just near surfaces.
//
// Exact distances between cell centres, by the lower envelope of parabolas along one axis after the other (Felzenszwalb and Huttenlocher
// 2012), in whole squares of cells.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/fields.h"
#include "mapper/integrate/tsdf_volume.h"

namespace waretwin {

struct DistanceFieldConfig {
  int cell_voxels = 0;
  double max_distance_m = 2.0;

  void visit(Fields& f) {
    f("cell_voxels", cell_voxels, "voxels along the edge of a cell: 1, 2, 4 or 8; 0: the least from 2 on that makes no more than 8 million",
      {.min = 0, .max = 8});
    f("max_distance_m", max_distance_m, "distances are cut to this", {.min = 0.01, .max = 32.0});
    if (cell_voxels != 0 && 8 % cell_voxels != 0) f.reject("cell_voxels", "must be 1, 2, 4 or 8");
  }
};

struct DistanceField {
  double resolution_m = 0.0;                         // edge of a cell
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // lowest corner of cell (0, 0, 0) in the world, metres
  int width = 0, depth = 0, height = 0;              // cells along x, y and z
  // x fastest, then y. Metres from the cell's centre to the nearest centre of an occupied cell; for an occupied cell less than 0: to the
  // nearest one that is not. Cut to +- max_distance_m. NaN where the cell is unknown.
  std::vector<float> distances;

  float at(int x, int y, int z) const {
    return distances[static_cast<std::size_t>(x) +
                     static_cast<std::size_t>(width) *
                         (static_cast<std::size_t>(y) + static_cast<std::size_t>(depth) * static_cast<std::size_t>(z))];
  }
};

// Over the box of all blocks. A cell is occupied where any of its voxels is, else free where any is, else unknown. No cells for an empty
// volume.
DistanceField make_distance_field(const TsdfVolume& volume, const DistanceFieldConfig& config);

// Squared distance in cells from each cell of a box to the nearest one that is `set`; a large number (> 2^28) where none is. The engine
// of the above; x fastest.
std::vector<std::int32_t> squared_distances(const std::vector<std::uint8_t>& set, int width, int depth, int height);

}  // namespace waretwin
