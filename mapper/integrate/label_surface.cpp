#include "mapper/integrate/label_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/parallel.h"

namespace waretwin {
namespace {

constexpr std::size_t kBlocks = 64;  // a piece of the parallel loop

struct LabelledPoint {
  std::int32_t label;
  Eigen::Vector3f p_W;
};

struct WantedLabel {
  std::int32_t label;
  Eigen::AlignedBox3i blocks;
};

// The blocks that hold a wanted label, ascending.
std::vector<std::size_t> blocks_of(const TsdfVolume& volume, const std::vector<WantedLabel>& wanted) {
  std::vector<std::size_t> positions;
  for (std::size_t position = 0; position < volume.size(); ++position) {
    const TsdfBlock& block = volume.block(position);
    if (!block.surface) continue;
    if (std::any_of(wanted.begin(), wanted.end(), [&](const WantedLabel& w) { return w.blocks.contains(block.index); })) {
      positions.push_back(position);
    }
  }
  std::sort(positions.begin(), positions.end(), [&](std::size_t a, std::size_t b) {
    const Eigen::Vector3i &ia = volume.block(a).index, &ib = volume.block(b).index;
    return std::lexicographical_compare(ia.data(), ia.data() + 3, ib.data(), ib.data() + 3);
  });
  return positions;
}

void collect(const TsdfVolume& volume, const TsdfBlock& block, const std::vector<WantedLabel>& wanted, std::vector<LabelledPoint>& points) {
  std::vector<std::int32_t> labels;  // few
  for (const WantedLabel& w : wanted) {
    if (w.blocks.contains(block.index)) labels.push_back(w.label);
  }
  const std::array<const TsdfBlock*, 3> beyond = {volume.find_block(block.index + Eigen::Vector3i::UnitX()),
                                                  volume.find_block(block.index + Eigen::Vector3i::UnitY()),
                                                  volume.find_block(block.index + Eigen::Vector3i::UnitZ())};
  const auto farthest = static_cast<float>(volume.truncation_m());
  for (int offset = 0; offset < TsdfVolume::kVoxels; ++offset) {
    if (!volume.has_surface(block, offset)) continue;
    const Eigen::Vector3i local(offset & 7, offset >> 3 & 7, offset >> 6);
    const float here = block.surface->voxels[static_cast<std::size_t>(offset)].distance;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3i next = local;
      const bool within = ++next[axis] < TsdfVolume::kSide;
      const TsdfBlock* other = within ? &block : beyond[static_cast<std::size_t>(axis)];
      const int place = TsdfVolume::offset(next.x() & 7, next.y() & 7, next.z() & 7);
      if (!other || !volume.has_surface(*other, place)) continue;
      const float there = other->surface->voxels[static_cast<std::size_t>(place)].distance;
      if ((here > 0.0f) == (there > 0.0f) || std::abs(here - there) > farthest) continue;
      const float share = here / (here - there);
      const std::int32_t label = share <= 0.5f ? block.surface->labels.best(offset) : other->surface->labels.best(place);
      if (std::find(labels.begin(), labels.end(), label) == labels.end()) continue;
      Eigen::Vector3d p_W = volume.voxel_centre(TsdfVolume::kSide * block.index + local);
      p_W[axis] += share * volume.voxel_m();
      points.push_back({label, p_W.cast<float>()});
    }
  }
}

}  // namespace

double label_reach_m(const TsdfConfig& config) {
  const double truncations = config.method == "projection" ? config.projection.along_truncations : 1.0;
  return truncations * config.truncation_m() + 2.0 * config.voxel_m;
}

std::map<std::int32_t, std::vector<Eigen::Vector3f>> label_surface(const TsdfVolume& volume,
                                                                   const std::map<std::int32_t, Eigen::AlignedBox3d>& labels) {
  std::vector<WantedLabel> wanted;
  for (const auto& [label, box] : labels) {
    if (box.isEmpty()) continue;
    wanted.push_back(
        {label, Eigen::AlignedBox3i(TsdfVolume::block_of(volume.voxel_at(box.min())), TsdfVolume::block_of(volume.voxel_at(box.max())))});
  }
  const std::vector<std::size_t> order = blocks_of(volume, wanted);
  std::vector<std::vector<LabelledPoint>> pieces((order.size() + kBlocks - 1) / kBlocks);
  parallel_for(order.size(), kBlocks, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) collect(volume, volume.block(order[i]), wanted, pieces[begin / kBlocks]);
  });
  std::map<std::int32_t, std::vector<Eigen::Vector3f>> result;
  for (const auto& piece : pieces) {
    for (const LabelledPoint& point : piece) result[point.label].push_back(point.p_W);
  }
  return result;
}

}  // namespace waretwin
