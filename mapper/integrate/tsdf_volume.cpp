#include "mapper/integrate/tsdf_volume.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

// 21 bits an axis; ascending keys are ascending (x, y, z).
std::uint64_t key_of(const Eigen::Vector3i& index) {
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + TsdfVolume::kMaxBlockIndex + 1); };
  return part(index.x()) << 42 | part(index.y()) << 21 | part(index.z());
}

bool in_range(const Eigen::Vector3i& index) {
  return index.minCoeff() >= -TsdfVolume::kMaxBlockIndex && index.maxCoeff() <= TsdfVolume::kMaxBlockIndex;
}

}  // namespace

Eigen::Vector3i TsdfVolume::voxel_at(const Eigen::Vector3d& p_W) const {
  // Beyond the reach of block indices there is nothing; the clamp keeps the conversion defined.
  const double limit = 8.0 * (kMaxBlockIndex + 8.0);
  Eigen::Vector3i voxel;
  for (int k = 0; k < 3; ++k) voxel[k] = static_cast<int>(std::floor(std::clamp(p_W[k] / config_.voxel_m, -limit, limit)));
  return voxel;
}

const TsdfBlock* TsdfVolume::find_block(const Eigen::Vector3i& index) const {
  if (!in_range(index)) return nullptr;
  const auto found = positions_.find(key_of(index));
  return found == positions_.end() ? nullptr : blocks_[found->second].get();
}

TsdfBlock* TsdfVolume::find_block(const Eigen::Vector3i& index) { return const_cast<TsdfBlock*>(std::as_const(*this).find_block(index)); }

std::size_t TsdfVolume::ensure_block(const Eigen::Vector3i& index) {
  WARETWIN_CHECK(in_range(index), "block outside the volume");
  const auto [entry, fresh] = positions_.try_emplace(key_of(index), blocks_.size());
  if (fresh) {
    blocks_.push_back(std::make_unique<TsdfBlock>());
    blocks_.back()->index = index;
  }
  return entry->second;
}

SurfaceVoxels& TsdfVolume::ensure_surface(std::size_t position) {
  TsdfBlock& block = *blocks_[position];
  if (!block.surface) block.surface = std::make_unique<SurfaceVoxels>();
  return *block.surface;
}

std::vector<std::size_t> TsdfVolume::sorted_positions() const {
  std::vector<std::size_t> order(blocks_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key_of(blocks_[a]->index) < key_of(blocks_[b]->index); });
  return order;
}

bool TsdfVolume::has_surface(const TsdfBlock& block, int offset) const {
  if (!block.surface) return false;
  const auto i = static_cast<std::size_t>(offset);
  const TsdfVoxel& voxel = block.surface->voxels[i];
  if (voxel.weight <= 0.0f || voxel.weight < config_.mesh_min_weight) return false;
  // Voxels that are forgotten need no second judgement.
  if (forgets_) return true;
  const int free_frames = block.free_frames[i];
  return config_.clear_frames == 0 || free_frames < config_.clear_frames || free_frames <= 2 * voxel.surface_frames;
}

const TsdfVoxel* TsdfVolume::find_voxel(const Eigen::Vector3i& voxel) const {
  const TsdfBlock* block = find_block(block_of(voxel));
  const int offset = offset_of(voxel);
  return block && has_surface(*block, offset) ? &block->surface->voxels[static_cast<std::size_t>(offset)] : nullptr;
}

std::int32_t TsdfVolume::label(const Eigen::Vector3i& voxel) const {
  const TsdfBlock* block = find_block(block_of(voxel));
  return block && block->surface ? block->surface->labels.best(offset_of(voxel)) : 0;
}

VoxelState TsdfVolume::state(const TsdfBlock& block, int offset) const {
  const auto i = static_cast<std::size_t>(offset);
  if (has_surface(block, offset)) {
    const float distance = block.surface->voxels[i].distance;
    const float reach = static_cast<float>(config_.voxel_m);
    if (std::abs(distance) <= reach) return VoxelState::occupied;
    if (distance > 0.0f) return VoxelState::free;
    // Behind a surface, as deep as it was recorded. Distances run along the rays, so that under grazing ones no voxel may come within
    // one voxel of 0: a level top seen from low would not be there at all.
    if (block.free_frames[i] <= block.surface->voxels[i].surface_frames) return VoxelState::occupied;
  }
  return block.free_frames[i] > 0 ? VoxelState::free : VoxelState::unknown;
}

VoxelState TsdfVolume::state(const Eigen::Vector3i& voxel) const {
  const TsdfBlock* block = find_block(block_of(voxel));
  return block ? state(*block, offset_of(voxel)) : VoxelState::unknown;
}

void TsdfVolume::expect_same_grid(const TsdfConfig& config) const {
  if (voxel_m() == config.voxel_m && config_.truncation_voxels == config.truncation_voxels) return;
  throw Error("mapper.integrate: voxel_m and truncation_voxels are " + std::to_string(config.voxel_m) + ", " +
              std::to_string(config.truncation_voxels) + "; expected the map's own, " + std::to_string(voxel_m()) + ", " +
              std::to_string(config_.truncation_voxels));
}

void TsdfVolume::configure(const TsdfConfig& config) {
  expect_same_grid(config);
  config_ = config;
  forgets_ = config.method == "projection" && config.projection.forget;
}

void TsdfVolume::merge_labels(std::int32_t from, std::int32_t to) { merge_labels(std::vector<std::pair<int, int>>{{from, to}}); }

void TsdfVolume::merge_labels(const std::vector<std::pair<int, int>>& merges) {
  if (merges.empty()) return;
  parallel_for(blocks_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (!blocks_[b]->surface) continue;
      LabelCounts& counts = blocks_[b]->surface->labels;
      // A block holds few of all labels.
      std::set<std::int32_t> present = counts.labels();
      for (const auto& [from, to] : merges) {
        if (from == to || present.erase(from) == 0) continue;
        counts.merge(from, to);
        present.insert(to);
      }
    }
  });
}

void TsdfVolume::add_to(Digest& digest) const {
  digest.add(config_.voxel_m);
  for (const std::size_t b : sorted_positions()) {
    const TsdfBlock& block = *blocks_[b];
    for (int k = 0; k < 3; ++k) digest.add(block.index[k]);
    digest.add_bytes(block.free_frames.data(), block.free_frames.size());
    digest.add(block.surface != nullptr);
    if (!block.surface) continue;
    digest.add_bytes(block.surface->voxels.data(), sizeof block.surface->voxels);
    for (int v = 0; v < kVoxels; ++v) {
      for (const auto& [label, count] : block.surface->labels.all(v)) {
        digest.add(v);
        digest.add(label);
        digest.add(count);
      }
    }
  }
}

std::size_t TsdfVolume::bytes() const {
  std::size_t sum = 0;
  for (const auto& block : blocks_) {
    sum += sizeof *block;
    if (block->surface) sum += sizeof block->surface->voxels + block->surface->labels.bytes();
  }
  return sum;
}

}  // namespace waretwin
