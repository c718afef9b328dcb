#include "mapper/integrate/free_space.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "mapper/integrate/depth_pyramid.h"
#include "mapper/integrate/frame_view.h"

namespace waretwin {

namespace {

class Carving {
 public:
  Carving(const DepthPyramid& pyramid, const Intrinsics& intrinsics, const Pose& X_WC, const TsdfConfig& config)
      : pyramid_(pyramid), intrinsics_(intrinsics), X_CW_(X_WC.inverse()), voxel_m_(config.voxel_m) {
    margin_ = static_cast<float>(config.truncation_m());
    focal_ = static_cast<float>(std::max(intrinsics.fx, intrinsics.fy));
    max_depth_ = static_cast<float>(config.max_depth_m);
    per_voxel_ = (X_CW_.linear() * voxel_m_).cast<float>();
  }

  // Bits of the voxels of one block that were seen through.
  bool carve(const Eigen::Vector3i& index, std::array<std::uint64_t, 8>& voxels) const {
    const double side = 8.0 * voxel_m_;
    const Eigen::Vector3f centre = (X_CW_ * ((index.cast<double>().array() + 0.5) * side).matrix()).cast<float>();
    const float radius = static_cast<float>(0.5 * side * std::sqrt(3.0));
    voxels.fill(0);
    if (centre.z() < -radius) return false;
    const float near = centre.z() - radius;
    // Off the axis a sphere's image reaches farther than focal * radius / near by the tangent's share.
    if (near > radius) {
      const auto [u, v] = pixel(centre);
      const float reach = footprint(centre, radius, near);
      if (u + reach < -0.5f || v + reach < -0.5f || u - reach > static_cast<float>(intrinsics_.width) - 0.5f ||
          v - reach > static_cast<float>(intrinsics_.height) - 0.5f) {
        return false;
      }
      const DepthPyramid::Range range = pyramid_.range(u, v, reach);
      if (range.largest <= near + margin_) return false;
      const bool inside = u - reach >= 0.0f && v - reach >= 0.0f && u + reach <= static_cast<float>(intrinsics_.width - 1) &&
                          v + reach <= static_cast<float>(intrinsics_.height - 1);
      if (inside && range.smallest > centre.z() + radius + margin_ && centre.z() + radius <= max_depth_) {
        voxels.fill(~std::uint64_t{0});
        return true;
      }
    }
    return carve_voxels(centre, voxels);
  }

 private:
  struct Pixel {
    float u, v;
  };
  Pixel pixel(const Eigen::Vector3f& p_C) const {
    return {static_cast<float>(intrinsics_.fx) * p_C.x() / p_C.z() + static_cast<float>(intrinsics_.cx),
            static_cast<float>(intrinsics_.fy) * p_C.y() / p_C.z() + static_cast<float>(intrinsics_.cy)};
  }
  // Half-width in pixels that holds the image of a sphere around p_C whose nearest depth is `near`.
  float footprint(const Eigen::Vector3f& p_C, float radius, float near) const {
    const float slope = std::max(std::abs(p_C.x()), std::abs(p_C.y())) / p_C.z();
    return focal_ * radius * (1.0f + slope) / near;
  }

  bool carve_voxels(const Eigen::Vector3f& centre, std::array<std::uint64_t, 8>& voxels) const {
    const float radius = static_cast<float>(0.5 * voxel_m_);
    std::uint64_t any = 0;
    for (int z = 0; z < 8; ++z) {
      for (int y = 0; y < 8; ++y) {
        const Eigen::Vector3f start =
            centre + per_voxel_ * Eigen::Vector3f(-3.5f, static_cast<float>(y) - 3.5f, static_cast<float>(z) - 3.5f);
        for (int x = 0; x < 8; ++x) {
          const Eigen::Vector3f p = start + per_voxel_.col(0) * static_cast<float>(x);
          const float near = p.z() - radius;
          if (near <= radius || p.z() > max_depth_) continue;
          const auto [u, v] = pixel(p);
          if (u < -0.5f || v < -0.5f || u >= static_cast<float>(intrinsics_.width) - 0.5f ||
              v >= static_cast<float>(intrinsics_.height) - 0.5f) {
            continue;
          }
          const std::uint64_t seen = pyramid_.range(u, v, focal_ * radius / near).smallest > p.z() + margin_;
          voxels[static_cast<std::size_t>(z)] |= seen << (8 * y + x);
          any |= seen;
        }
      }
    }
    return any != 0;
  }

  const DepthPyramid& pyramid_;
  const Intrinsics& intrinsics_;
  Pose X_CW_;
  double voxel_m_;
  Eigen::Matrix3f per_voxel_;  // step of one voxel along each axis of the world, in the camera's frame
  float margin_ = 0.0f, focal_ = 0.0f, max_depth_ = 0.0f;
};

}  // namespace

std::vector<FreeBlock> find_free_space(const RgbdFrame& frame, const Intrinsics& intrinsics, const Pose& X_WC, const TsdfConfig& config) {
  const DepthPyramid pyramid(frame.depth);
  const double depth = std::min(static_cast<double>(pyramid.largest()), config.max_depth_m);
  if (!(depth > 0.0)) return {};

  const double side = 8.0 * config.voxel_m;
  const auto [low, high] = viewing_box(intrinsics, X_WC, depth);
  Eigen::Vector3i first, count;
  for (int k = 0; k < 3; ++k) {
    first[k] = static_cast<int>(std::floor(low[k] / side));
    count[k] = static_cast<int>(std::floor(high[k] / side)) - first[k] + 1;
  }

  const Carving carving(pyramid, intrinsics, X_WC, config);
  const auto columns = static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y());
  constexpr std::size_t kColumns = 16;
  std::vector<std::vector<FreeBlock>> pieces((columns + kColumns - 1) / kColumns);
  parallel_for(columns, kColumns, [&](std::size_t begin, std::size_t end) {
    std::vector<FreeBlock>& found = pieces[begin / kColumns];
    for (std::size_t column = begin; column < end; ++column) {
      FreeBlock block;
      block.index.x() = first.x() + static_cast<int>(column) / count.y();
      block.index.y() = first.y() + static_cast<int>(column) % count.y();
      for (int z = 0; z < count.z(); ++z) {
        block.index.z() = first.z() + z;
        if (carving.carve(block.index, block.voxels)) found.push_back(block);
      }
    }
  });
  std::vector<FreeBlock> blocks;
  for (const auto& piece : pieces) blocks.insert(blocks.end(), piece.begin(), piece.end());
  return blocks;
}

}  // namespace waretwin
