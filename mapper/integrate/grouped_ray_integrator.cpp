#include "mapper/integrate/grouped_ray_integrator.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "mapper/integrate/frame_view.h"
#include "mapper/integrate/free_space.h"
#include "mapper/integrate/point_groups.h"

namespace waretwin {

namespace {

constexpr std::size_t kRaysPerPiece = 512;

// One voxel crossed by one ray.
struct Update {
  std::uint16_t block;  // in its piece's list
  std::uint16_t voxel;
  std::uint32_t group;
  float distance;  // not yet cut
};

// What a run of rays does, sorted by block.
struct Piece {
  std::vector<Eigen::Vector3i> blocks;
  std::vector<std::uint32_t> begin;  // of each block's updates; one more at the end
  std::vector<Update> updates;
};

class BlockList {
 public:
  explicit BlockList(std::vector<Eigen::Vector3i>& blocks) : blocks_(blocks) {}
  // Rays run through neighbouring blocks again and again: the newest entries are looked at first.
  std::uint16_t find(const Eigen::Vector3i& index) {
    if (last_ < blocks_.size() && blocks_[last_] == index) return static_cast<std::uint16_t>(last_);
    for (std::size_t i = blocks_.size(); i-- > 0;) {
      if (blocks_[i] == index) {
        last_ = i;
        return static_cast<std::uint16_t>(i);
      }
    }
    WARETWIN_CHECK(blocks_.size() < std::numeric_limits<std::uint16_t>::max(), "too many blocks in one piece");
    last_ = blocks_.size();
    blocks_.push_back(index);
    return static_cast<std::uint16_t>(last_);
  }

 private:
  std::vector<Eigen::Vector3i>& blocks_;
  std::size_t last_ = 0;
};

// Calls visit(voxel) for each voxel that the segment from a to b crosses, all in voxels (Amanatides and Woo 1987).
template <class Visit>
void traverse(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Visit&& visit) {
  Eigen::Vector3i voxel, step;
  Eigen::Vector3d next, delta;
  int count = 1;
  for (int k = 0; k < 3; ++k) {
    voxel[k] = static_cast<int>(std::floor(a[k]));
    count += std::abs(static_cast<int>(std::floor(b[k])) - voxel[k]);
    const double d = b[k] - a[k];
    step[k] = d > 0.0 ? 1 : -1;
    const bool moves = d != 0.0;
    delta[k] = moves ? 1.0 / std::abs(d) : std::numeric_limits<double>::infinity();
    next[k] = moves ? (d > 0.0 ? voxel[k] + 1.0 - a[k] : a[k] - voxel[k]) * delta[k] : std::numeric_limits<double>::infinity();
  }
  for (int i = 0; i < count; ++i) {
    visit(voxel);
    const int axis = next.x() < next.y() ? (next.x() < next.z() ? 0 : 2) : (next.y() < next.z() ? 1 : 2);
    voxel[axis] += step[axis];
    next[axis] += delta[axis];
  }
}

Piece cast_rays(const std::vector<PointGroup>& groups, std::size_t begin, std::size_t end, const Eigen::Vector3d& p_WC,
                const TsdfConfig& config) {
  Piece piece;
  std::vector<Update> updates;
  updates.reserve((end - begin) * 16);
  BlockList list(piece.blocks);
  const double per_voxel = 1.0 / config.voxel_m, truncation = config.truncation_m();
  const Eigen::Vector3d camera = p_WC * per_voxel;
  for (std::size_t g = begin; g < end; ++g) {
    const Eigen::Vector3d p = groups[g].mean.cast<double>();
    const double length = p.norm();
    if (length <= 0.0) continue;
    const Eigen::Vector3d direction = p / length;
    const Eigen::Vector3d a = camera + direction * (std::max(0.0, length - truncation) * per_voxel);
    const Eigen::Vector3d b = camera + direction * ((length + truncation) * per_voxel);
    traverse(a, b, [&](const Eigen::Vector3i& voxel) {
      const double along = ((voxel.cast<double>().array() + 0.5).matrix() - camera).dot(direction) * config.voxel_m;
      updates.push_back({list.find(TsdfVolume::block_of(voxel)), static_cast<std::uint16_t>(TsdfVolume::offset_of(voxel)),
                         static_cast<std::uint32_t>(g), static_cast<float>(length - along)});
    });
  }
  // Counting sort by block, which keeps the order of rays within one.
  piece.begin.assign(piece.blocks.size() + 1, 0);
  for (const Update& u : updates) ++piece.begin[u.block + 1u];
  for (std::size_t i = 1; i < piece.begin.size(); ++i) piece.begin[i] += piece.begin[i - 1];
  std::vector<std::uint32_t> at(piece.begin.begin(), piece.begin.end());
  piece.updates.resize(updates.size());
  for (const Update& u : updates) piece.updates[at[u.block]++] = u;
  return piece;
}

// All that one frame does to one block.
struct BlockWork {
  std::size_t position = 0;                                    // of the block in the volume
  std::vector<std::pair<std::uint32_t, std::uint16_t>> parts;  // piece, block in its list; ascending
};

std::vector<BlockWork> gather_work(const std::vector<Piece>& pieces, TsdfVolume& volume) {
  std::vector<BlockWork> work;
  std::vector<std::uint32_t> work_of_block;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (std::size_t b = 0; b < pieces[p].blocks.size(); ++b) {
      const std::size_t position = volume.ensure_block(pieces[p].blocks[b]);
      if (work_of_block.size() < volume.size()) work_of_block.resize(std::max(volume.size(), position + 1), kNone);
      if (work_of_block[position] == kNone) {
        work_of_block[position] = static_cast<std::uint32_t>(work.size());
        work.emplace_back().position = position;
      }
      work[work_of_block[position]].parts.emplace_back(static_cast<std::uint32_t>(p), static_cast<std::uint16_t>(b));
    }
  }
  return work;
}

// Eq. (6): which voxels of a block saw which label in this frame. A block sees few labels at once.
class LabelMasks {
 public:
  void set(std::int32_t label, std::uint16_t voxel) {
    if (last_ >= masks_.size() || masks_[last_].first != label) {
      last_ = 0;
      while (last_ < masks_.size() && masks_[last_].first != label) ++last_;
      if (last_ == masks_.size()) masks_.emplace_back(label, std::bitset<512>());
    }
    masks_[last_].second.set(voxel);
  }
  void count_into(LabelCounts& counts) {
    std::sort(masks_.begin(), masks_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [label, mask] : masks_) {
      for (int voxel = 0; voxel < 512; ++voxel) {
        if (mask[static_cast<std::size_t>(voxel)]) counts.add(voxel, label);
      }
    }
  }

 private:
  std::vector<std::pair<std::int32_t, std::bitset<512>>> masks_;
  std::size_t last_ = 0;
};

class Application {
 public:
  explicit Application(const TsdfConfig& config)
      : truncation_(static_cast<float>(config.truncation_m())),
        drop_from_(static_cast<float>(config.voxel_m)),
        label_band_(static_cast<float>(config.label_band_voxels * config.voxel_m)),
        max_weight_(static_cast<float>(config.max_weight)) {}

  void apply(const BlockWork& work, const std::vector<Piece>& pieces, const std::vector<PointGroup>& groups, SurfaceVoxels& surface) const {
    LabelMasks labels;
    std::bitset<512> touched;
    for (const auto& [p, b] : work.parts) {
      const Piece& piece = pieces[p];
      for (std::uint32_t i = piece.begin[b]; i < piece.begin[b + 1u]; ++i) {
        const Update& u = piece.updates[i];
        const PointGroup& group = groups[u.group];
        if (std::abs(u.distance) <= label_band_) labels.set(group.label, u.voxel);
        if (average(u.distance, group, surface.voxels[u.voxel])) touched.set(u.voxel);
      }
    }
    labels.count_into(surface.labels);
    for (std::size_t v = 0; v < 512; ++v) {
      std::uint8_t& frames = surface.voxels[v].surface_frames;
      if (touched[v] && frames < 255) ++frames;
    }
  }

 private:
  bool average(float distance, const PointGroup& group, TsdfVoxel& voxel) const {
    float weight = group.weight;
    if (distance < -drop_from_) {
      // With a truncation of one voxel there is no room for a slope.
      weight *= truncation_ > drop_from_ ? std::max(0.0f, (truncation_ + distance) / (truncation_ - drop_from_)) : 0.0f;
    }
    if (weight <= 0.0f) return false;
    const float sum = voxel.weight + weight;
    const float share = weight / sum;
    const float cut = std::clamp(distance, -truncation_, truncation_);
    voxel.distance += (cut - voxel.distance) * share;
    for (std::size_t k = 0; k < 3; ++k) {
      const float old = voxel.colour[k];
      voxel.colour[k] = static_cast<std::uint8_t>(old + (static_cast<float>(group.colour[k]) - old) * share + 0.5f);
    }
    voxel.weight = std::min(sum, max_weight_);
    return true;
  }

  float truncation_, drop_from_, label_band_, max_weight_;
};

void integrate_surfaces(const std::vector<PointGroup>& groups, const Eigen::Vector3d& p_WC, const TsdfConfig& config, TsdfVolume& volume) {
  std::vector<Piece> pieces((groups.size() + kRaysPerPiece - 1) / kRaysPerPiece);
  parallel_for(groups.size(), kRaysPerPiece,
               [&](std::size_t begin, std::size_t end) { pieces[begin / kRaysPerPiece] = cast_rays(groups, begin, end, p_WC, config); });
  const std::vector<BlockWork> work = gather_work(pieces, volume);
  const Application application(config);
  parallel_for(work.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) application.apply(work[i], pieces, groups, volume.ensure_surface(work[i].position));
  });
}

void record_free_space(const std::vector<FreeBlock>& free_blocks, TsdfVolume& volume) {
  for (const FreeBlock& free : free_blocks) {
    auto& frames = volume.block(volume.ensure_block(free.index)).free_frames;
    for (std::size_t z = 0; z < 8; ++z) {
      const std::uint64_t bits = free.voxels[z];
      for (std::size_t i = 0; i < 64; ++i) {
        const auto seen = static_cast<std::uint8_t>(bits >> i & 1u);
        std::uint8_t& count = frames[64 * z + i];
        count = static_cast<std::uint8_t>(count + (count == 255 ? 0 : seen));
      }
    }
  }
}

}  // namespace

void GroupedRayIntegrator::integrate(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels,
                                     const Pose& X_WC, TsdfVolume& volume) {
  check_frame(frame, intrinsics, labels);
  volume.expect_same_grid(config_);
  integrate_surfaces(group_points(frame, intrinsics, labels, X_WC, config_), X_WC.translation(), config_, volume);
  if (config_.carve) record_free_space(find_free_space(frame, intrinsics, X_WC, config_), volume);
}

}  // namespace waretwin
