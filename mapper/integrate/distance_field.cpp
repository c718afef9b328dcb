#include "mapper/integrate/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

constexpr std::int32_t kNever = 1 << 29;

// One line of n cells, `step` apart: least of (x - v)^2 + line[v] over all v. Ties and rounding of the borders choose between equal values
// alone, so that the result is exact.
class LineTransform {
 public:
  explicit LineTransform(int n) : in_(static_cast<std::size_t>(n)), place_(in_.size()), from_(in_.size() + 1) {}

  void run(std::int32_t* line, std::size_t step) {
    const int n = static_cast<int>(in_.size());
    for (int x = 0; x < n; ++x) in_[index(x)] = line[index(x) * step];
    int top = -1;
    for (int x = 0; x < n; ++x) {
      if (in_[index(x)] >= kNever) continue;
      double border = -std::numeric_limits<double>::infinity();
      while (top >= 0) {
        const int v = place_[index(top)];
        border = (height(x) - height(v)) / (2.0 * (x - v));
        if (border > from_[index(top)]) break;
        --top;
        border = -std::numeric_limits<double>::infinity();
      }
      ++top;
      place_[index(top)] = x;
      from_[index(top)] = border;
    }
    if (top < 0) return;
    int k = 0;
    for (int x = 0; x < n; ++x) {
      while (k < top && from_[index(k + 1)] < x) ++k;
      const int v = place_[index(k)];
      line[index(x) * step] = std::min(kNever, (x - v) * (x - v) + in_[index(v)]);
    }
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  double height(int x) const { return static_cast<double>(in_[index(x)]) + static_cast<double>(x) * x; }

  std::vector<std::int32_t> in_;
  std::vector<int> place_;
  std::vector<double> from_;
};

int fitting_cell(const Eigen::Vector3i& blocks) {
  constexpr double kMost = 8e6;
  int cell = 2;
  while (cell < TsdfVolume::kSide && blocks.cast<double>().prod() * std::pow(TsdfVolume::kSide / cell, 3) > kMost) cell *= 2;
  return cell;
}

}  // namespace

std::vector<std::int32_t> squared_distances(const std::vector<std::uint8_t>& set, int width, int depth, int height) {
  const auto w = static_cast<std::size_t>(width), d = static_cast<std::size_t>(depth), h = static_cast<std::size_t>(height);
  WARETWIN_CHECK(set.size() == w * d * h, "one byte a cell");
  std::vector<std::int32_t> squares(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) squares[i] = set[i] != 0 ? 0 : kNever;
  const auto along = [&](std::size_t lines, int length, std::size_t step, auto&& start) {
    parallel_for(lines, 64, [&](std::size_t begin, std::size_t end) {
      LineTransform transform(length);
      for (std::size_t line = begin; line < end; ++line) transform.run(squares.data() + start(line), step);
    });
  };
  along(d * h, width, 1, [&](std::size_t line) { return line * w; });
  along(w * h, depth, w, [&](std::size_t line) { return line / w * w * d + line % w; });
  along(w * d, height, w * d, [&](std::size_t line) { return line; });
  return squares;
}

DistanceField make_distance_field(const TsdfVolume& volume, const DistanceFieldConfig& config) {
  DistanceField field;
  if (volume.size() == 0) return field;
  Eigen::Vector3i low = volume.block(0).index, high = low;
  for (std::size_t b = 0; b < volume.size(); ++b) {
    low = low.cwiseMin(volume.block(b).index);
    high = high.cwiseMax(volume.block(b).index);
  }
  const Eigen::Vector3i blocks = high - low + Eigen::Vector3i::Ones();
  const int cell_voxels = config.cell_voxels > 0 ? config.cell_voxels : fitting_cell(blocks);
  const int side = TsdfVolume::kSide / cell_voxels;  // cells along a block
  const Eigen::Vector3i size = blocks * side;
  field.resolution_m = volume.voxel_m() * cell_voxels;
  field.origin = low.cast<double>() * (TsdfVolume::kSide * volume.voxel_m());
  field.width = size.x();
  field.depth = size.y();
  field.height = size.z();
  const auto w = static_cast<std::size_t>(size.x()), d = static_cast<std::size_t>(size.y());
  std::vector<VoxelState> states(w * d * static_cast<std::size_t>(size.z()), VoxelState::unknown);
  parallel_for(volume.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const TsdfBlock& block = volume.block(b);
      const Eigen::Vector3i corner = (block.index - low) * side;
      for (int offset = 0; offset < TsdfVolume::kVoxels; ++offset) {
        const VoxelState state = volume.state(block, offset);
        const Eigen::Vector3i cell = corner + Eigen::Vector3i(offset & 7, offset >> 3 & 7, offset >> 6) / cell_voxels;
        VoxelState& all =
            states[static_cast<std::size_t>(cell.x()) + w * (static_cast<std::size_t>(cell.y()) + d * static_cast<std::size_t>(cell.z()))];
        all = std::max(all, state);
      }
    }
  });
  static_assert(VoxelState::unknown < VoxelState::free && VoxelState::free < VoxelState::occupied);
  std::vector<std::uint8_t> set(states.size());
  const auto mark = [&](bool occupied) {
    for (std::size_t i = 0; i < states.size(); ++i) set[i] = (states[i] == VoxelState::occupied) == occupied;
    return squared_distances(set, field.width, field.depth, field.height);
  };
  const std::vector<std::int32_t> to_occupied = mark(true), to_others = mark(false);
  field.distances.resize(states.size());
  const auto metres = [&](std::int32_t squares) {
    return static_cast<float>(std::min(config.max_distance_m, std::sqrt(static_cast<double>(squares)) * field.resolution_m));
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    field.distances[i] = states[i] == VoxelState::unknown    ? std::numeric_limits<float>::quiet_NaN()
                         : states[i] == VoxelState::occupied ? -metres(to_others[i])
                                                             : metres(to_occupied[i]);
  }
  return field;
}

}  // namespace waretwin
