#include "mapper/integrate/surface_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "core/pose.h"

namespace waretwin {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kLargest = 8;  // pixels along a patch
constexpr std::size_t kRowsPerPiece = 6;
// One pixel strays about as far as the mean of its patch times this.
constexpr float kPixelNoise = 3.0f;

class Patching {
 public:
  Patching(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels, const TsdfConfig& config)
      : frame_(frame), intrinsics_(intrinsics), labels_(labels), config_(config) {
    side_ = chosen_patch_px(config, intrinsics);
    width_ = (intrinsics.width + side_ - 1) / side_;
    height_ = (intrinsics.height + side_ - 1) / side_;
    const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    means_.resize(count);
    slopes_.resize(count);
    result_.patch_px = side_;
    result_.width = width_;
    result_.height = height_;
    result_.patches.resize(count + 1);
    max_depth_ = static_cast<float>(config.max_depth_m);
    noise_ = static_cast<float>(config.projection.depth_noise_share);
    const double steepest = to_radians(config.projection.max_incidence_deg);
    // Largest change of depth from pixel to pixel, as a share of depth.
    steep_share_ = static_cast<float>(std::tan(steepest) / std::min(intrinsics.fx, intrinsics.fy));
    least_cosine_ = static_cast<float>(std::cos(steepest));
    least_count_ = std::max(1, side_ * side_ / 4);
    reject_edges_ = config.projection.reject_edges;
  }

  PatchImage run() {
    const auto rows = static_cast<std::size_t>(height_);
    const auto each_row = [&](auto&& body) {
      parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
      });
    };
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      Columns columns(static_cast<std::size_t>(width_ * side_));
      for (std::size_t y = begin; y < end; ++y) average_row(static_cast<int>(y), columns);
    });
    each_row([&](int y) { slope_row(y); });
    each_row([&](int y) { plane_row(y); });
    return std::move(result_);
  }

 private:
  // Of one patch's pixels.
  struct Mean {
    float w = 0.0f;            // inverse depth, 1/m; 0: too few pixels
    float u = 0.0f, v = 0.0f;  // mean pixel
    float spread = 0.0f;       // largest less smallest depth, metres
    float share = 0.0f;        // of the patch's pixels that count
  };
  struct Slope {
    float u = 0.0f, v = 0.0f;  // of inverse depth, 1/m per pixel
    bool known = false;
  };
  // Sums down the rows of a patch, per column of pixels.
  struct Columns {
    explicit Columns(std::size_t width) : count(width), w(width), v(width), nearest(width), farthest(width) {}
    std::vector<float> count, w, v, nearest, farthest;
  };

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  bool valid(float z) const { return (z > 0.0f) & (z <= max_depth_); }

  void sum_columns(int y, Columns& c) const {
    std::fill(c.count.begin(), c.count.end(), 0.0f);
    std::fill(c.w.begin(), c.w.end(), 0.0f);
    std::fill(c.v.begin(), c.v.end(), 0.0f);
    std::fill(c.nearest.begin(), c.nearest.end(), kFar);
    std::fill(c.farthest.begin(), c.farthest.end(), 0.0f);
    const int v1 = std::min(intrinsics_.height, side_ * (y + 1));
    const float far = max_depth_;
    for (int v = side_ * y; v < v1; ++v) {
      const float* const line = frame_.depth.ptr<float>(v);
      const auto row = static_cast<float>(v);
      float *const count = c.count.data(), *const w = c.w.data(), *const vs = c.v.data();
      float *const nearest = c.nearest.data(), *const farthest = c.farthest.data();
      for (int u = 0; u < intrinsics_.width; ++u) {
        const float z = line[u];
        const bool ok = (z > 0.0f) & (z <= far);
        const float one = ok ? 1.0f : 0.0f;
        const float inverse = 1.0f / (ok ? z : 1.0f);
        count[u] += one;
        w[u] += ok ? inverse : 0.0f;
        vs[u] += ok ? row : 0.0f;
        const float low = ok ? z : kFar, high = ok ? z : 0.0f;
        nearest[u] = low < nearest[u] ? low : nearest[u];
        farthest[u] = high > farthest[u] ? high : farthest[u];
      }
    }
  }

  void average_row(int y, Columns& c) {
    sum_columns(y, c);
    for (int x = 0; x < width_; ++x) {
      float count = 0.0f, w = 0.0f, u_sum = 0.0f, v_sum = 0.0f, nearest = kFar, farthest = 0.0f;
      for (int i = 0; i < side_; ++i) {
        const auto u = static_cast<std::size_t>(x * side_ + i);
        count += c.count[u];
        w += c.w[u];
        u_sum += c.count[u] * static_cast<float>(u);
        v_sum += c.v[u];
        nearest = std::min(nearest, c.nearest[u]);
        farthest = std::max(farthest, c.farthest[u]);
      }
      SurfacePatch& patch = result_.patches[at(x, y)];
      Mean& mean = means_[at(x, y)];
      if (count < static_cast<float>(least_count_)) continue;
      const float tolerance = farthest * (steep_share_ * static_cast<float>(side_) + kPixelNoise * noise_);
      const bool mixed = farthest - nearest > tolerance;
      float from = 0.0f, to = kFar;
      if (mixed) {
        const float middle = 0.5f * (nearest + farthest);
        take_larger_part(x, y, middle, mean);
        if (mean.w <= 0.0f) continue;
        from = 1.0f / mean.w < middle ? 0.0f : middle;
        to = 1.0f / mean.w < middle ? middle : kFar;
      } else {
        const float scale = 1.0f / count;
        mean = {w * scale, u_sum * scale, v_sum * scale, farthest - nearest, count / static_cast<float>(side_ * side_)};
      }
      paint(x, y, mixed, from, to, patch);
      patch.label = labels_.empty() ? 0 : label_of(x, y, from, to);
    }
  }

  template <class Visit>
  void for_pixels(int x, int y, Visit&& visit) const {
    const int u1 = std::min(intrinsics_.width, side_ * (x + 1)), v1 = std::min(intrinsics_.height, side_ * (y + 1));
    for (int v = side_ * y; v < v1; ++v) {
      const float* const line = frame_.depth.ptr<float>(v);
      for (int u = side_ * x; u < u1; ++u) {
        if (valid(line[u])) visit(u, v, line[u]);
      }
    }
  }

  // Pixels nearer or farther than `middle`, whichever are more; of equally many the nearer ones.
  void take_larger_part(int x, int y, float middle, Mean& mean) const {
    struct Part {
      float count = 0.0f, w = 0.0f, u = 0.0f, v = 0.0f, nearest = kFar, farthest = 0.0f;
    };
    std::array<Part, 2> parts;
    for_pixels(x, y, [&](int u, int v, float z) {
      Part& p = parts[z < middle ? 0 : 1];
      p.count += 1.0f;
      p.w += 1.0f / z;
      p.u += static_cast<float>(u);
      p.v += static_cast<float>(v);
      p.nearest = std::min(p.nearest, z);
      p.farthest = std::max(p.farthest, z);
    });
    const Part& p = parts[parts[0].count >= parts[1].count ? 0 : 1];
    if (p.count < static_cast<float>(least_count_)) return;
    const float scale = 1.0f / p.count;
    mean = {p.w * scale, p.u * scale, p.v * scale, p.farthest - p.nearest, p.count / static_cast<float>(side_ * side_)};
  }

  void paint(int x, int y, bool mixed, float from, float to, SurfacePatch& patch) const {
    int blue = 0, green = 0, red = 0, count = 0;
    const auto take = [&](int u, int v) {
      const std::uint8_t* const bgr = frame_.colour.ptr<std::uint8_t>(v) + 3 * u;
      blue += bgr[0];
      green += bgr[1];
      red += bgr[2];
      ++count;
    };
    if (mixed) {
      for_pixels(x, y, [&](int u, int v, float z) {
        if (z >= from && z < to) take(u, v);
      });
    } else {
      // The middle four: colour blurs over more than that in the camera itself.
      const int step = side_ > 1 ? 1 : 0, u0 = side_ * x + side_ / 2 - step, v0 = side_ * y + side_ / 2 - step;
      for (int v = v0; v <= std::min(v0 + step, intrinsics_.height - 1); ++v) {
        for (int u = u0; u <= std::min(u0 + step, intrinsics_.width - 1); ++u) take(u, v);
      }
    }
    if (count == 0) return;
    patch.red = static_cast<std::uint8_t>((red + count / 2) / count);
    patch.green = static_cast<std::uint8_t>((green + count / 2) / count);
    patch.blue = static_cast<std::uint8_t>((blue + count / 2) / count);
  }

  std::int32_t label_of(int x, int y, float from, float to) const {
    const int u0 = side_ * x, v0 = side_ * y;
    const int u1 = std::min(intrinsics_.width, u0 + side_), v1 = std::min(intrinsics_.height, v0 + side_);
    const auto row = [&](int v) { return labels_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(intrinsics_.width); };
    const std::int32_t first = row(v0)[u0];
    bool same = true;
    for (int v = v0; v < v1; ++v) {
      for (int u = u0; u < u1; ++u) same &= row(v)[u] == first;
    }
    if (same) return first;
    std::array<std::int32_t, kLargest * kLargest> seen;
    std::size_t count = 0;
    for_pixels(x, y, [&](int u, int v, float z) {
      if (z >= from && z < to) seen[count++] = row(v)[u];
    });
    std::sort(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(count));
    std::int32_t best = 0;
    std::size_t most = 0;
    for (std::size_t i = 0, j = 0; i < count; i = j) {
      while (j < count && seen[j] == seen[i]) ++j;
      if (j - i > most) {
        most = j - i;
        best = seen[i];
      }
    }
    return best;
  }

  // From the two sides of a patch. `disagreement`: how far the sides' slopes may lie apart on one plane.
  static float slope_between(const Mean& low, const Mean& here, const Mean& high, float Mean::*place, float disagreement, bool& known) {
    const bool has_low = low.w > 0.0f, has_high = high.w > 0.0f;
    known = has_low || has_high;
    if (!known) return 0.0f;
    const float below = has_low ? (here.w - low.w) / (here.*place - low.*place) : 0.0f;
    const float above = has_high ? (high.w - here.w) / (high.*place - here.*place) : 0.0f;
    if (!has_low) return above;
    if (!has_high) return below;
    if (std::abs(below - above) <= disagreement) return (high.w - low.w) / (high.*place - low.*place);
    return std::abs(below) < std::abs(above) ? below : above;
  }

  const Mean& mean_at(int x, int y) const {
    static constexpr Mean kNothing{};
    return x >= 0 && y >= 0 && x < width_ && y < height_ ? means_[at(x, y)] : kNothing;
  }

  void slope_row(int y) {
    const float per_patch = noise_ / static_cast<float>(side_);
    for (int x = 0; x < width_; ++x) {
      const Mean& here = means_[at(x, y)];
      if (here.w <= 0.0f) continue;
      const float disagreement = here.w * per_patch;
      bool along_u = false, along_v = false;
      Slope& slope = slopes_[at(x, y)];
      slope.u = slope_between(mean_at(x - 1, y), here, mean_at(x + 1, y), &Mean::u, disagreement, along_u);
      slope.v = slope_between(mean_at(x, y - 1), here, mean_at(x, y + 1), &Mean::v, disagreement, along_v);
      slope.known = along_u && along_v;
    }
  }

  void plane_row(int y) {
    const auto fx = static_cast<float>(intrinsics_.fx), fy = static_cast<float>(intrinsics_.fy);
    const auto cx = static_cast<float>(intrinsics_.cx), cy = static_cast<float>(intrinsics_.cy);
    for (int x = 0; x < width_; ++x) {
      const Mean& here = means_[at(x, y)];
      if (here.w <= 0.0f) continue;
      const Slope& own = slopes_[at(x, y)];
      if (!own.known) continue;
      float su = own.u, sv = own.v;
      int friends = 0;
      for (int j = std::max(0, y - 1); j <= std::min(height_ - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(width_ - 1, x + 1); ++i) {
          const Mean& other = means_[at(i, j)];
          const Slope& slope = slopes_[at(i, j)];
          if ((i == x && j == y) || other.w <= 0.0f || !slope.known) continue;
          const float expected = here.w + own.u * (other.u - here.u) + own.v * (other.v - here.v);
          if (std::abs(other.w - expected) > noise_ * here.w) continue;
          su += slope.u;
          sv += slope.v;
          ++friends;
        }
      }
      const float scale = 1.0f / static_cast<float>(friends + 1);
      su *= scale;
      sv *= scale;
      const float depth = 1.0f / here.w;
      if (reject_edges_) {
        const float sloped = (std::abs(su) + std::abs(sv)) * static_cast<float>(side_) * depth * depth;
        if (friends < 2 || here.spread > sloped + kPixelNoise * noise_ * depth) continue;
      }
      const float qx = su * fx, qy = sv * fy, qz = here.w + su * (cx - here.u) + sv * (cy - here.v);
      const float h = 1.0f / std::sqrt(qx * qx + qy * qy + qz * qz);
      const float rx = (here.u - cx) / fx, ry = (here.v - cy) / fy;
      const float cosine = h * here.w / std::sqrt(rx * rx + ry * ry + 1.0f);
      if (!(cosine >= least_cosine_)) continue;
      SurfacePatch& patch = result_.patches[at(x, y)];
      patch.depth = depth;
      patch.weight = here.share * (config_.inverse_square_weight ? here.w * here.w : 1.0f);
      if (config_.projection.incidence_weight) patch.weight *= cosine;
      if (config_.projection.plane_distance) {
        patch.nx = qx * h;
        patch.ny = qy * h;
        patch.nz = qz * h;
        patch.h = h;
      } else {
        patch.nz = 1.0f;
        patch.h = depth;
      }
    }
  }

  const RgbdFrame& frame_;
  const Intrinsics& intrinsics_;
  const std::vector<std::int32_t>& labels_;
  const TsdfConfig& config_;
  int side_ = 0, width_ = 0, height_ = 0, least_count_ = 1;
  float max_depth_ = 0.0f, noise_ = 0.0f, steep_share_ = 0.0f, least_cosine_ = 0.0f;
  bool reject_edges_ = true;
  std::vector<Mean> means_;
  std::vector<Slope> slopes_;
  PatchImage result_;
};

}  // namespace

int chosen_patch_px(const TsdfConfig& config, const Intrinsics& intrinsics) {
  const int asked = config.projection.patch_px;
  if (asked > 0) return asked;
  constexpr double kDepth = 1.5;
  const double fits = 0.5 * config.voxel_m * std::max(intrinsics.fx, intrinsics.fy) / kDepth;
  int side = 1;
  while (2 * side <= kLargest && 2.0 * side <= fits) side *= 2;
  return side;
}

PatchImage make_patches(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels,
                        const TsdfConfig& config) {
  return Patching(frame, intrinsics, labels, config).run();
}

}  // namespace waretwin
