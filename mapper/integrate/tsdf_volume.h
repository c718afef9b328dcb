// The map's volume: a truncated signed distance field in hashed blocks of 8 x 8 x 8 voxels, each voxel with colour and label counts.
//
// Curless and Levoy 1996 for the distances, Oleynikova et al. 2017 (Voxblox) for the blocks, the paper's section 3.4 with eqs. (6) and
// (7) for the labels. Free space is kept beside the distances, as the number of frames that saw through a voxel, so that it costs one
// byte a voxel where there is no surface and never pulls at the distances of one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/digest.h"
#include "mapper/integrate/label_counts.h"
#include "mapper/integrate/tsdf_config.h"

namespace waretwin {

struct TsdfVoxel {
  float distance = 0.0f;                    // metres to the surface, > 0 before it, within +- truncation; unset while weight is 0
  float weight = 0.0f;                      // sum of the weights of what was averaged; 0: no surface near
  std::array<std::uint8_t, 3> colour = {};  // red, green, blue
  std::uint8_t surface_frames = 0;          // frames that put a surface near here, up to 255
};

// The voxels of a block that has a surface in or near it.
struct SurfaceVoxels {
  std::array<TsdfVoxel, 512> voxels;
  LabelCounts labels;
};

struct TsdfBlock {
  Eigen::Vector3i index;                           // voxels 8 * index to 8 * index + 7 on each axis
  std::unique_ptr<SurfaceVoxels> surface;          // none in blocks that were only seen to be free
  std::array<std::uint8_t, 512> free_frames = {};  // frames that saw through it, up to 255; by projection less what spoke for a surface
};

// Occupied: within one voxel of a surface, or behind one as deep as it was recorded and not seen through more often. Free: before a
// surface, or seen through by any frame. Unknown: neither.
enum class VoxelState : std::uint8_t { unknown, free, occupied };

class TsdfVolume {
 public:
  static constexpr int kSide = 8;
  static constexpr int kVoxels = kSide * kSide * kSide;
  static constexpr int kMaxBlockIndex = (1 << 20) - 1;

  explicit TsdfVolume(const TsdfConfig& config) : config_(config), forgets_(config.method == "projection" && config.projection.forget) {}

  const TsdfConfig& config() const { return config_; }
  double voxel_m() const { return config_.voxel_m; }
  double truncation_m() const { return config_.truncation_m(); }

  // Place of a voxel in its block from its coordinates in [0, 8).
  static constexpr int offset(int x, int y, int z) { return x + kSide * (y + kSide * z); }
  // Voxel i covers [i, i + 1) * voxel_m on each axis of the world.
  Eigen::Vector3i voxel_at(const Eigen::Vector3d& p_W) const;
  Eigen::Vector3d voxel_centre(const Eigen::Vector3i& voxel) const { return (voxel.cast<double>().array() + 0.5) * config_.voxel_m; }
  static Eigen::Vector3i block_of(const Eigen::Vector3i& voxel) { return {voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3}; }
  static int offset_of(const Eigen::Vector3i& voxel) { return offset(voxel.x() & 7, voxel.y() & 7, voxel.z() & 7); }

  std::size_t size() const { return blocks_.size(); }  // blocks
  TsdfBlock& block(std::size_t position) { return *blocks_[position]; }
  const TsdfBlock& block(std::size_t position) const { return *blocks_[position]; }
  const TsdfBlock* find_block(const Eigen::Vector3i& index) const;  // nullptr where nothing was ever seen
  TsdfBlock* find_block(const Eigen::Vector3i& index);
  // Position of a block, made if need be. Not thread-safe; other blocks stay where they are.
  std::size_t ensure_block(const Eigen::Vector3i& index);
  SurfaceVoxels& ensure_surface(std::size_t position);
  // Positions of all blocks in ascending order of (x, y, z): the order of everything that is written.
  std::vector<std::size_t> sorted_positions() const;

  // A voxel with a surface near it that was not taken out again; nullptr else.
  const TsdfVoxel* find_voxel(const Eigen::Vector3i& voxel) const;
  std::int32_t label(const Eigen::Vector3i& voxel) const;  // eq. (7); 0 where nothing was counted
  VoxelState state(const Eigen::Vector3i& voxel) const;
  VoxelState state_at(const Eigen::Vector3d& p_W) const { return state(voxel_at(p_W)); }

  // True where the block's voxel takes part in mesh and occupancy: enough weight, and not seen through too often (clear_frames).
  bool has_surface(const TsdfBlock& block, int offset) const;
  VoxelState state(const TsdfBlock& block, int offset) const;

  // Throws Error where a configuration's voxel size or truncation are not those of this volume (a map that is resumed with other settings).
  void expect_same_grid(const TsdfConfig& config) const;
  // Goes on under another configuration of the same grid; throws Error as above.
  void configure(const TsdfConfig& config);

  // From now on, what was counted as `from` counts as `to` (objects that turned out to be one).
  void merge_labels(std::int32_t from, std::int32_t to);
  // The same for a list of (from, to), one after the other, in one pass.
  void merge_labels(const std::vector<std::pair<int, int>>& merges);

  // Fingerprint of every voxel and count, in sorted order of blocks.
  void add_to(Digest& digest) const;
  std::size_t bytes() const;  // memory of all blocks

 private:
  TsdfConfig config_;
  bool forgets_;  // voxels seen through too often lose their surface at once
  std::vector<std::unique_ptr<TsdfBlock>> blocks_;
  std::unordered_map<std::uint64_t, std::size_t> positions_;
};

}  // namespace waretwin
