#include "mapper/integrate/projective_integrator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "mapper/integrate/depth_pyramid.h"
#include "mapper/integrate/surface_patches.h"

namespace waretwin {

namespace {

constexpr std::size_t kColumnsPerPiece = 16, kBlocksPerPiece = 32;
constexpr int kSlice = 64;  // voxels of one layer of a block

enum class Seen : std::uint8_t { free, mixed };

struct Candidate {
  Eigen::Vector3i index;
  Seen seen = Seen::mixed;
};

// One layer of a block as the camera sees it.
struct Layer {
  std::array<float, kSlice> x, y, z;  // camera's frame, metres
  std::array<std::int32_t, kSlice> patch, around;
};

// The voxels' positions and what they project into; `outside` is the patch of those that the picture does not show.
struct Projection {
  float fx, fy, cx, cy;
  float patches_per_pixel, around_per_pixel;
  int patch_width, around_width;
  float right, bottom;  // ends of the picture, pixels
  float nearest, farthest;
  std::int32_t outside;
};

void project(const Projection& c, const Eigen::Vector3f& start, const Eigen::Vector3f& along_x, const Eigen::Vector3f& along_y,
             Layer& out) {
  const float sx = start.x(), sy = start.y(), sz = start.z();
  const float ax = along_x.x(), ay = along_x.y(), az = along_x.z();
  const float bx = along_y.x(), by = along_y.y(), bz = along_y.z();
  for (int i = 0; i < kSlice; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto column = static_cast<float>(i & 7), row = static_cast<float>(i >> 3);
    const float x = sx + ax * column + bx * row, y = sy + ay * column + by * row, z = sz + az * column + bz * row;
    const bool before = (z > c.nearest) & (z <= c.farthest);
    const float inverse = 1.0f / (before ? z : 1.0f);
    // From the picture's left upper corner, so that cutting off rounds down.
    const float u = c.fx * x * inverse + c.cx + 0.5f, v = c.fy * y * inverse + c.cy + 0.5f;
    const bool inside = before & (u >= 0.0f) & (v >= 0.0f) & (u < c.right) & (v < c.bottom);
    const float uu = inside ? u : 0.0f, vv = inside ? v : 0.0f;
    const auto patch =
        static_cast<std::int32_t>(vv * c.patches_per_pixel) * c.patch_width + static_cast<std::int32_t>(uu * c.patches_per_pixel);
    out.x[k] = x;
    out.y[k] = y;
    out.z[k] = z;
    out.patch[k] = inside ? patch : c.outside;
    out.around[k] =
        static_cast<std::int32_t>(vv * c.around_per_pixel) * c.around_width + static_cast<std::int32_t>(uu * c.around_per_pixel);
  }
}

class Projecting {
 public:
  Projecting(const PatchImage& image, const DepthPyramid& pyramid, const Intrinsics& intrinsics, const Pose& X_WC, const TsdfConfig& config)
      : image_(image), pyramid_(pyramid), intrinsics_(intrinsics), config_(config), X_CW_(X_WC.inverse()) {
    voxel_ = static_cast<float>(config.voxel_m);
    truncation_ = static_cast<float>(config.truncation_m());
    behind_ = static_cast<float>(std::min(config.projection.behind_voxels, config.truncation_voxels) * config.voxel_m);
    along_ = static_cast<float>(config.projection.along_truncations * config.truncation_m());
    label_band_ = static_cast<float>(config.label_band_voxels * config.voxel_m);
    max_weight_ = static_cast<float>(config.max_weight);
    max_depth_ = static_cast<float>(config.max_depth_m);
    focal_ = static_cast<float>(std::max(intrinsics.fx, intrinsics.fy));
    per_voxel_ = (X_CW_.linear() * config.voxel_m).cast<float>();
    memory_ = config.projection.memory_frames;
    forget_after_ = config.clear_frames;
    block_radius_ = static_cast<float>(4.0 * config.voxel_m * std::sqrt(3.0));
    // How fast a point that goes on by one voxel to every side can leave the image of the block's middle.
    projection_ = {static_cast<float>(intrinsics.fx),
                   static_cast<float>(intrinsics.fy),
                   static_cast<float>(intrinsics.cx),
                   static_cast<float>(intrinsics.cy),
                   1.0f / static_cast<float>(image.patch_px),
                   0.0f,
                   image.width,
                   0,
                   static_cast<float>(intrinsics.width),
                   static_cast<float>(intrinsics.height),
                   0.5f * voxel_,
                   max_depth_ + truncation_,
                   static_cast<std::int32_t>(image.patches.size()) - 1};
  }

  // Blocks of one column that the frame says something about.
  void find(const Eigen::Vector3i& first, int count, std::vector<Candidate>& found) const {
    const double side = 8.0 * config_.voxel_m;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3i index = first + Eigen::Vector3i(0, 0, i);
      const Eigen::Vector3f centre = (X_CW_ * ((index.cast<double>().array() + 0.5) * side).matrix()).cast<float>();
      const float near = centre.z() - block_radius_, far = centre.z() + block_radius_;
      if (far <= 0.0f || near > max_depth_ + truncation_) continue;
      if (near <= block_radius_) {
        found.push_back({index, Seen::mixed});
        continue;
      }
      // Off the axis a sphere's image reaches farther than focal * radius / near by the tangent's share.
      const float slope = std::max(std::abs(centre.x()), std::abs(centre.y())) / centre.z();
      const float reach = focal_ * block_radius_ * (1.0f + slope) / near;
      const float u = projection_.fx * centre.x() / centre.z() + projection_.cx;
      const float v = projection_.fy * centre.y() / centre.z() + projection_.cy;
      if (u + reach < -0.5f || v + reach < -0.5f || u - reach > projection_.right - 0.5f || v - reach > projection_.bottom - 0.5f) continue;
      const DepthPyramid::Range range = pyramid_.range(u, v, reach);
      // Behind all that is seen here.
      if (range.largest + along_ < near) continue;
      const bool inside =
          u - reach >= 0.0f && v - reach >= 0.0f && u + reach <= projection_.right - 1.0f && v + reach <= projection_.bottom - 1.0f;
      // All before it, so far that no plane comes near either.
      if (inside && range.smallest > far + along_ && far <= max_depth_) {
        if (config_.carve) found.push_back({index, Seen::free});
        continue;
      }
      found.push_back({index, Seen::mixed});
    }
  }

  // What the frame does to a block. `surface` may be null; where the block gets its first one, `fresh` becomes it. True where anything
  // changed.
  bool update(const Candidate& candidate, SurfaceVoxels* surface, std::array<std::uint8_t, 512>& free_frames,
              std::unique_ptr<SurfaceVoxels>& fresh) const {
    if (candidate.seen == Seen::free) {
      for (std::size_t i = 0; i < 512; ++i) see_through(i, surface, free_frames);
      return true;
    }
    const double side = 8.0 * config_.voxel_m;
    const Eigen::Vector3f centre = (X_CW_ * ((candidate.index.cast<double>().array() + 0.5) * side).matrix()).cast<float>();
    // A voxel's image is at most this large anywhere in the block.
    const float near = std::max(centre.z() - block_radius_, voxel_);
    const float slope = (std::max(std::abs(centre.x()), std::abs(centre.y())) + block_radius_) / near;
    const float footprint = focal_ * 0.5f * voxel_ * (1.0f + slope) / std::max(near - 0.5f * voxel_, 0.5f * voxel_);
    const DepthPyramid::Surroundings around = pyramid_.surroundings(footprint);
    Projection projection = projection_;
    projection.around_per_pixel = around.per_pixel;
    projection.around_width = around.width;
    bool changed = false;
    Layer layer;
    for (int z = 0; z < 8; ++z) {
      const Eigen::Vector3f start = centre + per_voxel_ * Eigen::Vector3f(-3.5f, -3.5f, static_cast<float>(z) - 3.5f);
      project(projection, start, per_voxel_.col(0), per_voxel_.col(1), layer);
      for (std::size_t i = 0; i < kSlice; ++i) {
        const SurfacePatch& patch = image_.patches[static_cast<std::size_t>(layer.patch[i])];
        const float ahead = patch.nx * layer.x[i] + patch.ny * layer.y[i] + patch.nz * layer.z[i];
        const float distance = patch.h - ahead;
        const std::size_t voxel = static_cast<std::size_t>(z) * kSlice + i;
        // d / (n . p) is how much farther the plane lies than the voxel on its line of sight, as a share of its depth.
        if ((patch.weight > 0.0f) & (distance >= -behind_) & (distance <= truncation_) &
            (layer.z[i] * std::abs(distance) <= along_ * ahead)) {
          if (!surface) {
            fresh = std::make_unique<SurfaceVoxels>();
            surface = fresh.get();
          }
          changed |= average(voxel, distance, patch, *surface, free_frames);
        } else if (config_.carve && layer.patch[i] != projection.outside && layer.z[i] <= max_depth_ &&
                   around.smallest[layer.around[i]] > layer.z[i] + truncation_) {
          see_through(voxel, surface, free_frames);
          changed = true;
        }
      }
    }
    return changed;
  }

 private:
  bool average(std::size_t i, float distance, const SurfacePatch& patch, SurfaceVoxels& surface,
               std::array<std::uint8_t, 512>& free_frames) const {
    float weight = patch.weight;
    // With one voxel behind the surface there is no room for a slope.
    if (distance < -voxel_) weight *= behind_ > voxel_ ? (behind_ + distance) / (behind_ - voxel_) : 0.0f;
    if (std::abs(distance) <= label_band_) surface.labels.add(static_cast<int>(i), patch.label);
    if (weight <= 0.0f) return false;
    TsdfVoxel& voxel = surface.voxels[i];
    const float sum = voxel.weight + weight;
    const float share = weight / sum;
    voxel.distance += (distance - voxel.distance) * share;
    const auto blend = [share](std::uint8_t& old, std::uint8_t add) {
      const float before = old;
      old = static_cast<std::uint8_t>(before + (static_cast<float>(add) - before) * share + 0.5f);
    };
    blend(voxel.colour[0], patch.red);
    blend(voxel.colour[1], patch.green);
    blend(voxel.colour[2], patch.blue);
    voxel.weight = std::min(sum, max_weight_);
    if (distance >= -voxel_) {
      if (voxel.surface_frames < memory_) ++voxel.surface_frames;
      free_frames[i] = static_cast<std::uint8_t>(std::max(0, free_frames[i] - 2));
    }
    return true;
  }

  void see_through(std::size_t i, SurfaceVoxels* surface, std::array<std::uint8_t, 512>& free_frames) const {
    const int frames = std::min(free_frames[i] + 1, 4 * memory_);
    free_frames[i] = static_cast<std::uint8_t>(frames);
    if (!surface || !config_.projection.forget || forget_after_ == 0 || frames < forget_after_) return;
    TsdfVoxel& voxel = surface->voxels[i];
    if (voxel.weight <= 0.0f || voxel.distance > voxel_ || frames <= 2 * voxel.surface_frames) return;
    voxel = TsdfVoxel{};
    surface->labels.clear(static_cast<int>(i));
  }

  const PatchImage& image_;
  const DepthPyramid& pyramid_;
  const Intrinsics& intrinsics_;
  const TsdfConfig& config_;
  Pose X_CW_;
  Projection projection_{};
  Eigen::Matrix3f per_voxel_;  // step of one voxel along each axis of the world, in the camera's frame
  float voxel_ = 0.0f, truncation_ = 0.0f, behind_ = 0.0f, along_ = 0.0f, label_band_ = 0.0f, max_weight_ = 0.0f, max_depth_ = 0.0f;
  float focal_ = 0.0f, block_radius_ = 0.0f;
  int memory_ = 0, forget_after_ = 0;
};

std::vector<Candidate> find_blocks(const Projecting& projecting, const Intrinsics& intrinsics, const Pose& X_WC, double depth,
                                   const TsdfConfig& config) {
  // Box of blocks around the viewing pyramid.
  const double side = 8.0 * config.voxel_m;
  Eigen::Vector3d low = X_WC.translation(), high = low;
  for (const double u : {-0.5, intrinsics.width - 0.5}) {
    for (const double v : {-0.5, intrinsics.height - 0.5}) {
      const Eigen::Vector3d corner = X_WC * (intrinsics.ray(u, v) * depth);
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  const double reach = side * static_cast<double>(TsdfVolume::kMaxBlockIndex);
  for (int k = 0; k < 3; ++k) {
    if (low[k] > -reach && high[k] < reach) continue;
    throw Error("camera at " + std::to_string(X_WC.translation()[k]) + " m on axis " + std::to_string(k) + "; expected less than " +
                std::to_string(reach) + " m from the map's origin");
  }
  Eigen::Vector3i first, count;
  for (int k = 0; k < 3; ++k) {
    first[k] = static_cast<int>(std::floor(low[k] / side));
    count[k] = static_cast<int>(std::floor(high[k] / side)) - first[k] + 1;
  }
  const auto columns = static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y());
  std::vector<std::vector<Candidate>> pieces((columns + kColumnsPerPiece - 1) / kColumnsPerPiece);
  parallel_for(columns, kColumnsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t column = begin; column < end; ++column) {
      const Eigen::Vector3i bottom = first + Eigen::Vector3i(static_cast<int>(column) / count.y(), static_cast<int>(column) % count.y(), 0);
      projecting.find(bottom, count.z(), pieces[begin / kColumnsPerPiece]);
    }
  });
  std::vector<Candidate> found;
  for (const auto& piece : pieces) found.insert(found.end(), piece.begin(), piece.end());
  return found;
}

// What a frame makes of a block that was not there before.
struct NewBlock {
  std::size_t candidate;
  std::array<std::uint8_t, 512> free_frames;
  std::unique_ptr<SurfaceVoxels> surface;
};

void update_blocks(const Projecting& projecting, const std::vector<Candidate>& candidates, TsdfVolume& volume) {
  std::vector<TsdfBlock*> known(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) known[i] = volume.find_block(candidates[i].index);
  std::vector<std::vector<NewBlock>> pieces((candidates.size() + kBlocksPerPiece - 1) / kBlocksPerPiece);
  parallel_for(candidates.size(), kBlocksPerPiece, [&](std::size_t begin, std::size_t end) {
    NewBlock made;
    for (std::size_t i = begin; i < end; ++i) {
      std::unique_ptr<SurfaceVoxels> fresh;
      if (known[i]) {
        projecting.update(candidates[i], known[i]->surface.get(), known[i]->free_frames, fresh);
        if (fresh) known[i]->surface = std::move(fresh);
        continue;
      }
      made.free_frames.fill(0);
      if (!projecting.update(candidates[i], nullptr, made.free_frames, fresh)) continue;
      pieces[begin / kBlocksPerPiece].push_back({i, made.free_frames, std::move(fresh)});
    }
  });
  for (auto& piece : pieces) {
    for (NewBlock& made : piece) {
      TsdfBlock& block = volume.block(volume.ensure_block(candidates[made.candidate].index));
      block.free_frames = made.free_frames;
      block.surface = std::move(made.surface);
    }
  }
}

}  // namespace

void ProjectiveIntegrator::integrate(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels,
                                     const Pose& X_WC, TsdfVolume& volume) {
  const auto pixels = static_cast<std::size_t>(intrinsics.width) * static_cast<std::size_t>(intrinsics.height);
  WARETWIN_CHECK(frame.depth.type() == CV_32FC1 && frame.colour.type() == CV_8UC3, "frame of another type");
  WARETWIN_CHECK(frame.depth.cols == intrinsics.width && frame.depth.rows == intrinsics.height && frame.colour.size() == frame.depth.size(),
                 "frame of another size than its intrinsics");
  WARETWIN_CHECK(labels.empty() || labels.size() == pixels, "one label per pixel");
  volume.expect_same_grid(config_);
  const DepthPyramid pyramid(frame.depth);
  const double depth = std::min(static_cast<double>(pyramid.largest()), config_.max_depth_m);
  if (!(depth > 0.0)) return;
  const PatchImage image = make_patches(frame, intrinsics, labels, config_);
  const Projecting projecting(image, pyramid, intrinsics, X_WC, config_);
  // Planes reach as far behind the farthest depth as voxels are updated there.
  update_blocks(projecting, find_blocks(projecting, intrinsics, X_WC, depth + config_.truncation_m(), config_), volume);
}

}  // namespace waretwin
