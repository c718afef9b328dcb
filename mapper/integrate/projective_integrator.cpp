#include "mapper/integrate/projective_integrator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "mapper/integrate/depth_pyramid.h"
#include "mapper/integrate/frame_view.h"
#include "mapper/integrate/surface_patches.h"

namespace waretwin {

namespace {

constexpr std::size_t kColumnsPerPiece = 16, kBlocksPerPiece = 32;
constexpr int kPart = 64;  // voxels of an eighth of a block
constexpr float kFar = std::numeric_limits<float>::infinity();

// What a frame says about a box: nothing, that it is free as a whole, or something else for each voxel.
enum class Seen : std::uint8_t { nothing, free, mixed };

struct Candidate {
  Eigen::Vector3i index;
  Seen seen = Seen::mixed;
};

// A cube of 4 x 4 x 4 voxels, an eighth of a block, as the camera sees it.
struct Part {
  std::array<float, kPart> x, y, z;  // of each voxel's centre: camera's frame, metres
  std::array<std::int32_t, kPart> patch, around;
  std::array<float, kPart> distance;         // to the patch's plane
  std::array<std::uint8_t, kPart> on_plane;  // 1: near enough to it to be updated
};

// Bounds of a box in the picture and in depth.
struct Extent {
  float u0 = kFar, v0 = kFar, u1 = -kFar, v1 = -kFar;  // pixels
  float near = kFar, far = -kFar;                      // metres

  void add(float u, float v, float z) {
    u0 = std::min(u0, u);
    u1 = std::max(u1, u);
    v0 = std::min(v0, v);
    v1 = std::max(v1, v);
    near = std::min(near, z);
    far = std::max(far, z);
  }
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

constexpr float when(bool condition) { return condition ? 1.0f : 0.0f; }

// 16 voxels of one layer, without branches, so that compilers take several at once. `s`: the first one's centre; `a`, `b`: steps along x
// and y.
void project_layer(const Projection& projection, const Eigen::Vector3f& s, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                   float* __restrict xs, float* __restrict ys, float* __restrict zs, std::int32_t* __restrict patches,
                   std::int32_t* __restrict around) {
  static constexpr float kColumn[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  static constexpr float kRow[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  const Projection c = projection;
  const float sx = s.x(), sy = s.y(), sz = s.z(), ax = a.x(), ay = a.y(), az = a.z(), bx = b.x(), by = b.y(), bz = b.z();
  for (int k = 0; k < 16; ++k) {
    const float x = sx + ax * kColumn[k] + bx * kRow[k], y = sy + ay * kColumn[k] + by * kRow[k], z = sz + az * kColumn[k] + bz * kRow[k];
    const float before = when(z > c.nearest) * when(z <= c.farthest);
    const float inverse = 1.0f / (before > 0.0f ? z : 1.0f);
    // From the picture's left upper corner, so that cutting off rounds down.
    const float u = c.fx * x * inverse + c.cx + 0.5f, v = c.fy * y * inverse + c.cy + 0.5f;
    const float inside = before * when(u >= 0.0f) * when(v >= 0.0f) * when(u < c.right) * when(v < c.bottom);
    const float uu = inside > 0.0f ? u : 0.0f, vv = inside > 0.0f ? v : 0.0f;
    const int patch =
        static_cast<std::int32_t>(vv * c.patches_per_pixel) * c.patch_width + static_cast<std::int32_t>(uu * c.patches_per_pixel);
    xs[k] = x;
    ys[k] = y;
    zs[k] = z;
    patches[k] = inside > 0.0f ? patch : c.outside;
    around[k] = static_cast<std::int32_t>(vv * c.around_per_pixel) * c.around_width + static_cast<std::int32_t>(uu * c.around_per_pixel);
  }
}

// Corners of a block's eighths in the picture, x fastest: (0, 4, 8) voxels along each axis, and a few more to make whole loops.
struct Lattice {
  static constexpr int kPoints = 27, kPadded = 32;
  std::array<float, kPadded> x{}, y{}, z{};  // before: from the block's corner, camera's frame
  std::array<float, kPadded> u{}, v{}, depth{};

  static int at(int i, int j, int k) { return i + 3 * (j + 3 * k); }
};

void project_lattice(const Projection& projection, const Eigen::Vector3f& corner, Lattice& lattice) {
  const Projection c = projection;
  const float x0 = corner.x(), y0 = corner.y(), z0 = corner.z();
  for (std::size_t i = 0; i < Lattice::kPadded; ++i) {
    const float x = x0 + lattice.x[i], y = y0 + lattice.y[i], z = z0 + lattice.z[i];
    const float inverse = 1.0f / (z > c.nearest ? z : c.nearest);
    lattice.u[i] = c.fx * x * inverse + c.cx;
    lattice.v[i] = c.fy * y * inverse + c.cy;
    lattice.depth[i] = z;
  }
}

// Of the box of `span` eighths (1 or 2) along each axis whose lowest corner is lattice point (i, j, k).
Extent extent_of(const Lattice& lattice, int i, int j, int k, int span) {
  Extent extent;
  for (int n = 0; n < 8; ++n) {
    const auto at = static_cast<std::size_t>(Lattice::at(i + span * (n & 1), j + span * (n >> 1 & 1), k + span * (n >> 2)));
    extent.add(lattice.u[at], lattice.v[at], lattice.depth[at]);
  }
  return extent;
}

// `start`: centre of the part's first voxel; steps of one voxel along the axes of the world.
void project(const Projection& projection, const Eigen::Vector3f& start, const Eigen::Matrix3f& step, Part& out) {
  for (int layer = 0; layer < 4; ++layer) {
    const std::size_t k = 16 * static_cast<std::size_t>(layer);
    project_layer(projection, start + step.col(2) * static_cast<float>(layer), step.col(0), step.col(1), out.x.data() + k, out.y.data() + k,
                  out.z.data() + k, out.patch.data() + k, out.around.data() + k);
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
    along_behind_ = static_cast<float>(config.projection.along_truncations) * behind_;
    label_band_ = static_cast<float>(config.label_band_voxels * config.voxel_m);
    max_weight_ = static_cast<float>(config.max_weight);
    max_depth_ = static_cast<float>(config.max_depth_m);
    focal_ = static_cast<float>(std::max(intrinsics.fx, intrinsics.fy));
    per_voxel_ = (X_CW_.linear() * config.voxel_m).cast<float>();
    memory_ = config.projection.memory_frames;
    forget_after_ = config.clear_frames;
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
    for (int i = 0; i < Lattice::kPoints; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector3f p =
          per_voxel_ * (4.0f * Eigen::Vector3f(static_cast<float>(i % 3), static_cast<float>(i / 3 % 3), static_cast<float>(i / 9)));
      lattice_.x[k] = p.x();
      lattice_.y[k] = p.y();
      lattice_.z[k] = p.z();
    }
  }

  // Blocks of one column that the frame says something about.
  void find(const Eigen::Vector3i& first, int count, std::vector<Candidate>& found) const {
    Lattice lattice = lattice_;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3i index = first + Eigen::Vector3i(0, 0, i);
      const Eigen::Vector3f corner = corner_of(index);
      project_lattice(projection_, corner, lattice);
      const Seen seen = judge(extent_of(lattice, 0, 0, 0, 2));
      if (seen != Seen::nothing) found.push_back({index, seen});
    }
  }

  // What the frame does to a block. `surface` may be null; where the block gets its first one, `fresh` becomes it. True where anything
  // changed.
  bool update(const Candidate& candidate, SurfaceVoxels* surface, std::array<std::uint8_t, 512>& free_frames,
              std::unique_ptr<SurfaceVoxels>& fresh) const {
    if (candidate.seen == Seen::free) {
      if (surface) {
        for (std::size_t i = 0; i < 512; ++i) see_through(i, surface, free_frames);
      } else {
        const auto limit = static_cast<std::uint8_t>(4 * memory_);
        for (std::uint8_t& frames : free_frames) frames = static_cast<std::uint8_t>(frames < limit ? frames + 1 : limit);
      }
      return true;
    }
    const Eigen::Vector3f corner = corner_of(candidate.index);
    Lattice lattice = lattice_;
    project_lattice(projection_, corner, lattice);
    bool changed = false;
    for (int part = 0; part < 8; ++part) {
      const int x = 4 * (part & 1), y = 4 * (part >> 1 & 1), z = 4 * (part >> 2);
      const Extent extent = extent_of(lattice, x / 4, y / 4, z / 4, 1);
      const Seen seen = judge(extent);
      if (seen == Seen::free) {
        for (std::size_t i = 0; i < kPart; ++i) see_through(voxel_of(x, y, z, i), surface, free_frames);
        changed = true;
      } else if (seen == Seen::mixed) {
        changed |= update_part(corner, x, y, z, extent.near, surface, free_frames, fresh);
        if (fresh) surface = fresh.get();
      }
    }
    return changed;
  }

 private:
  // Lowest corner of a block in the camera's frame.
  Eigen::Vector3f corner_of(const Eigen::Vector3i& index) const {
    return (X_CW_ * (index.cast<double>() * (8.0 * config_.voxel_m))).cast<float>();
  }

  Seen judge(const Extent& e) const {
    if (e.far <= projection_.nearest || e.near > projection_.farthest) return Seen::nothing;
    if (e.near <= projection_.nearest) return Seen::mixed;
    if (e.u1 < -0.5f || e.v1 < -0.5f || e.u0 > projection_.right - 0.5f || e.v0 > projection_.bottom - 0.5f) return Seen::nothing;
    const DepthPyramid::Range range = pyramid_.range(e.u0, e.v0, e.u1, e.v1);
    // Behind all that is seen here.
    if (range.largest + along_behind_ < e.near) return Seen::nothing;
    const bool inside = e.u0 >= 0.0f && e.v0 >= 0.0f && e.u1 <= projection_.right - 1.0f && e.v1 <= projection_.bottom - 1.0f;
    // All before it, so far that no plane comes near either: planes lie within their pixels' depths, but for a little.
    if (inside && range.smallest > e.far + along_ + voxel_ && e.far <= max_depth_) return config_.carve ? Seen::free : Seen::nothing;
    return Seen::mixed;
  }

  static std::size_t voxel_of(int x, int y, int z, std::size_t i) {
    const auto k = static_cast<int>(i);
    return static_cast<std::size_t>(TsdfVolume::offset(x + (k & 3), y + (k >> 2 & 3), z + (k >> 4)));
  }

  bool update_part(const Eigen::Vector3f& corner, int x, int y, int z, float nearest, SurfaceVoxels* surface,
                   std::array<std::uint8_t, 512>& free_frames, std::unique_ptr<SurfaceVoxels>& fresh) const {
    const Eigen::Vector3f start = corner + per_voxel_ * (Eigen::Vector3i(x, y, z).cast<float>().array() + 0.5f).matrix();
    // A voxel's image reaches no farther than this anywhere in the part; off the axis by the tangent's share more.
    const float near = std::max(nearest, voxel_);
    const float slope = (std::max(std::abs(start.x()), std::abs(start.y())) + 7.0f * voxel_) / near;
    const float footprint = focal_ * 0.5f * voxel_ * (1.0f + slope) / near;
    const DepthPyramid::Surroundings around = pyramid_.surroundings(footprint);
    Projection projection = projection_;
    projection.around_per_pixel = around.per_pixel;
    projection.around_width = around.width;
    Part part;
    project(projection, start, per_voxel_, part);
    measure(part);
    bool changed = false;
    for (std::size_t i = 0; i < kPart; ++i) {
      if (part.on_plane[i] != 0) {
        if (!surface) {
          fresh = std::make_unique<SurfaceVoxels>();
          surface = fresh.get();
        }
        const SurfacePatch& patch = image_.patches[static_cast<std::size_t>(part.patch[i])];
        changed |= average(voxel_of(x, y, z, i), part.distance[i], patch, *surface, free_frames);
      } else if (config_.carve && part.patch[i] != projection.outside && part.z[i] <= max_depth_ &&
                 around.smallest[part.around[i]] > part.z[i] + truncation_) {
        see_through(voxel_of(x, y, z, i), surface, free_frames);
        changed = true;
      }
    }
    return changed;
  }

  void measure(Part& part) const {
    std::array<float, kPart> ahead, h;
    for (std::size_t i = 0; i < kPart; ++i) {
      const PatchPlane& plane = image_.planes[static_cast<std::size_t>(part.patch[i])];
      ahead[i] = plane.nx * part.x[i] + plane.ny * part.y[i] + plane.nz * part.z[i];
      h[i] = plane.h;
    }
    const float behind = behind_, truncation = truncation_, along = along_, along_behind = along_behind_;
    for (std::size_t i = 0; i < kPart; ++i) {
      const float d = h[i] - ahead[i];
      part.distance[i] = d;
      // d / (n . p) is how much farther the plane lies than the voxel on its line of sight, as a share of its depth.
      part.on_plane[i] = static_cast<std::uint8_t>(when(d >= -behind) * when(d <= truncation) * when(part.z[i] * d <= along * ahead[i]) *
                                                   when(-part.z[i] * d <= along_behind * ahead[i]));
    }
  }

  bool average(std::size_t i, float distance, const SurfacePatch& patch, SurfaceVoxels& surface,
               std::array<std::uint8_t, 512>& free_frames) const {
    float weight = patch.weight;
    // With one voxel behind the surface there is no room for a slope.
    if (distance < -voxel_) weight *= behind_ > voxel_ ? (behind_ + distance) / (behind_ - voxel_) : 0.0f;
    if (std::abs(distance) <= label_band_) surface.labels.add(static_cast<int>(i), patch.label);
    if (weight <= 0.0f) return false;
    TsdfVoxel& voxel = surface.voxels[i];
    // What the voxel holds for a surface, this frame sees well before one.
    const bool against = forgets() && distance > 2.0f * voxel_ && voxel.weight > 0.0f && voxel.distance <= voxel_;
    if (against) see_through(i, &surface, free_frames);
    const float sum = voxel.weight + weight;
    const float share = weight / sum;
    voxel.distance += (distance - voxel.distance) * share;
    // In 2^-16, rounded.
    const auto parts = static_cast<int>(share * 65536.0f + 0.5f);
    const auto blend = [parts](std::uint8_t& old, std::uint8_t add) {
      old = static_cast<std::uint8_t>(old + (((add - old) * parts + 32768) >> 16));
    };
    blend(voxel.colour[0], patch.red);
    blend(voxel.colour[1], patch.green);
    blend(voxel.colour[2], patch.blue);
    voxel.weight = std::min(sum, max_weight_);
    if (distance >= -voxel_ && !against) {
      if (voxel.surface_frames < memory_) ++voxel.surface_frames;
      free_frames[i] = static_cast<std::uint8_t>(std::max(0, free_frames[i] - 2));
    }
    return true;
  }

  bool forgets() const { return config_.projection.forget && forget_after_ > 0; }

  void see_through(std::size_t i, SurfaceVoxels* surface, std::array<std::uint8_t, 512>& free_frames) const {
    const int frames = std::min(free_frames[i] + 1, 4 * memory_);
    free_frames[i] = static_cast<std::uint8_t>(frames);
    if (!surface || !forgets() || frames < forget_after_) return;
    TsdfVoxel& voxel = surface->voxels[i];
    if (voxel.weight <= 0.0f || voxel.distance > voxel_ || frames <= 2 * std::min<int>(voxel.surface_frames, memory_)) return;
    voxel = TsdfVoxel{};
    surface->labels.clear(static_cast<int>(i));
  }

  const PatchImage& image_;
  const DepthPyramid& pyramid_;
  const Intrinsics& intrinsics_;
  const TsdfConfig& config_;
  Pose X_CW_;
  Projection projection_{};
  Lattice lattice_;
  Eigen::Matrix3f per_voxel_;  // step of one voxel along each axis of the world, in the camera's frame
  float voxel_ = 0.0f, truncation_ = 0.0f, behind_ = 0.0f, along_ = 0.0f, along_behind_ = 0.0f, label_band_ = 0.0f, max_weight_ = 0.0f,
        max_depth_ = 0.0f;
  float focal_ = 0.0f;
  int memory_ = 0, forget_after_ = 0;
};

std::vector<Candidate> find_blocks(const Projecting& projecting, const Intrinsics& intrinsics, const Pose& X_WC, double depth,
                                   const TsdfConfig& config) {
  const double side = 8.0 * config.voxel_m;
  const auto [low, high] = viewing_box(intrinsics, X_WC, depth);
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
  check_frame(frame, intrinsics, labels);
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
