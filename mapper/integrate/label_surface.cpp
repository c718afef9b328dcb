#include "mapper/integrate/label_surface.h"

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

void collect(const TsdfVolume& volume, const TsdfBlock& block, const std::set<std::int32_t>& labels, std::vector<LabelledPoint>& points) {
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
      if (!labels.contains(label)) continue;
      Eigen::Vector3d p_W = volume.voxel_centre(TsdfVolume::kSide * block.index + local);
      p_W[axis] += share * volume.voxel_m();
      points.push_back({label, p_W.cast<float>()});
    }
  }
}

}  // namespace

std::map<std::int32_t, std::vector<Eigen::Vector3f>> label_surface(const TsdfVolume& volume, const std::set<std::int32_t>& labels) {
  std::map<std::int32_t, std::vector<Eigen::Vector3f>> result;
  if (labels.empty()) return result;
  const std::vector<std::size_t> order = volume.sorted_positions();
  std::vector<std::vector<LabelledPoint>> pieces((order.size() + kBlocks - 1) / kBlocks);
  parallel_for(order.size(), kBlocks, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const TsdfBlock& block = volume.block(order[i]);
      if (block.surface) collect(volume, block, labels, pieces[begin / kBlocks]);
    }
  });
  for (const auto& piece : pieces) {
    for (const LabelledPoint& point : piece) result[point.label].push_back(point.p_W);
  }
  return result;
}

}  // namespace waretwin
