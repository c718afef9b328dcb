// What all frames tell about the space around one object, cell by cell: the probability that the paper's section 4.3 names as the better
// idea, in place of accumulated points.
//
// A ray with depth that may show the object ends in a cell (a hit: of the object, of something else, or of unknown label) and passes
// all cells before it. A cell is filled where more rays end in it than pass it, and the object's where its hits are more than
// outside_weight times those of others. Cells are flat slices: a pass is counted where the ray crosses the slice's middle plane.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapper/associate/evidence_config.h"
#include "mapper/segment/segmenter.h"

namespace waretwin {

struct EvidenceCell {
  std::uint16_t object = 0, other = 0, unknown = 0;  // hits
  std::uint16_t passed = 0;
  float z_sum = 0.0f;  // metres above the cell's bottom, of the object's hits

  int hits() const { return object + other + unknown; }
};

class EvidenceGrid {
 public:
  explicit EvidenceGrid(const EvidenceConfig& config) : config_(config) {}

  // Adds rays that start at `from_W`. The grid first grows around `candidates_W`, the box in which the object may be, by the margin.
  void add(const Eigen::Vector3d& from_W, const std::vector<EvidenceRay>& rays, const Eigen::AlignedBox3d& candidates_W);
  // Adds all that another grid counted (two halves of one object).
  void add(const EvidenceGrid& other);

  bool empty() const { return cells_.empty(); }
  // Number of cells along x, y, z.
  const Eigen::Vector3i& size() const { return size_; }
  const Eigen::Vector3d& origin() const { return origin_; }             // lower corner of cell (0, 0, 0), world, metres
  Eigen::Vector3d cell_size() const { return {cell_, cell_, slice_}; }  // metres
  const EvidenceCell& cell(int x, int y, int z) const { return cells_[index(x, y, z)]; }
  std::size_t bytes() const { return cells_.capacity() * sizeof(EvidenceCell); }

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  // Makes the grid hold the box and the margin around it, with cells no smaller than `least_cell`.
  void cover(const Eigen::AlignedBox3d& box_W, double least_cell = 0.0);
  // Adds the counts of cells no larger than this grid's own.
  void pour(const std::vector<EvidenceCell>& cells, const Eigen::Vector3d& origin, const Eigen::Vector3i& size,
            const Eigen::Vector3d& cell);

  EvidenceConfig config_;
  double cell_ = 0.0, slice_ = 0.0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<EvidenceCell> cells_;
};

}  // namespace waretwin
