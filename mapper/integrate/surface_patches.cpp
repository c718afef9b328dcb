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

// Rows of patches as arrays of one quantity each, with an empty patch at either end, so that loops over a row need no cases.
struct Means {
  // Of one row: inverse depth (1/m; 0: too few pixels), mean pixel, largest less smallest depth (metres), share of the pixels that count.
  std::vector<float> w, u, v, spread, share;
  // Slopes of inverse depth along u and v, 1/m per pixel; known: 1, else 0.
  std::vector<float> slope_u, slope_v, known;

  void resize(std::size_t count) {
    for (auto* column : {&w, &u, &v, &spread, &share, &slope_u, &slope_v, &known}) column->assign(count, 0.0f);
  }
};

// Sums down the rows of a patch, per column of pixels.
struct Columns {
  explicit Columns(std::size_t width) : count(width), w(width), v(width), nearest(width, kFar), farthest(width) {}
  std::vector<float> count, w, v, nearest, farthest;
};

// `rows` lines of depth from row `first` on.
template <int kRows>
void sum_columns(const float* line, std::size_t stride, int rows, int width, float first, float far, Columns& c) {
  const int count = kRows > 0 ? kRows : rows;
  float *const counts = c.count.data(), *const ws = c.w.data(), *const vs = c.v.data();
  float *const nearest = c.nearest.data(), *const farthest = c.farthest.data();
  for (int u = 0; u < width; ++u) {
    float n = 0.0f, w = 0.0f, v = 0.0f, low = kFar, high = 0.0f;
    for (int r = 0; r < count; ++r) {
      const float z = line[static_cast<std::size_t>(r) * stride + static_cast<std::size_t>(u)];
      const bool ok = (z > 0.0f) & (z <= far);
      const float inverse = 1.0f / (ok ? z : 1.0f);
      n += ok ? 1.0f : 0.0f;
      w += ok ? inverse : 0.0f;
      v += ok ? first + static_cast<float>(r) : 0.0f;
      const float near_z = ok ? z : kFar, far_z = ok ? z : 0.0f;
      low = near_z < low ? near_z : low;
      high = far_z > high ? far_z : high;
    }
    counts[u] = n;
    ws[u] = w;
    vs[u] = v;
    nearest[u] = low;
    farthest[u] = high;
  }
}

// Slopes from the two sides of each patch of a row: between both where they agree, of the flatter one where not. `place` is u or v.
struct Side {
  const float *w, *place;
};
void slopes_between(const Side& low, const Side& here, const Side& high, float per_patch, int width, float* slope, float* known) {
  for (int x = 0; x < width; ++x) {
    const bool has_low = low.w[x] > 0.0f, has_high = high.w[x] > 0.0f;
    const float below = (here.w[x] - low.w[x]) / (has_low ? here.place[x] - low.place[x] : 1.0f);
    const float above = (high.w[x] - here.w[x]) / (has_high ? high.place[x] - here.place[x] : 1.0f);
    const float across = (high.w[x] - low.w[x]) / (has_low & has_high ? high.place[x] - low.place[x] : 1.0f);
    const float flatter = std::abs(below) < std::abs(above) ? below : above;
    const float both = std::abs(below - above) <= here.w[x] * per_patch ? across : flatter;
    const float one = has_low ? below : above;
    slope[x] = has_low & has_high ? both : one;
    known[x] = (has_low | has_high) & (here.w[x] > 0.0f) ? known[x] : 0.0f;
  }
}

class Patching {
 public:
  Patching(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels, const TsdfConfig& config)
      : frame_(frame), intrinsics_(intrinsics), labels_(labels), config_(config) {
    side_ = chosen_patch_px(config, intrinsics);
    width_ = (intrinsics.width + side_ - 1) / side_;
    height_ = (intrinsics.height + side_ - 1) / side_;
    stride_ = static_cast<std::size_t>(width_) + 2;
    means_.resize(stride_ * (static_cast<std::size_t>(height_) + 2));
    result_.patch_px = side_;
    result_.width = width_;
    result_.height = height_;
    result_.patches.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1);
    max_depth_ = static_cast<float>(config.max_depth_m);
    noise_ = static_cast<float>(config.projection.depth_noise_share);
    const double steepest = to_radians(config.projection.max_incidence_deg);
    // Largest change of depth from pixel to pixel, as a share of depth.
    steep_share_ = static_cast<float>(std::tan(steepest) / std::min(intrinsics.fx, intrinsics.fy));
    least_cosine_ = static_cast<float>(std::cos(steepest));
    least_count_ = static_cast<float>(std::max(1, side_ * side_ / 4));
    reject_edges_ = config.projection.reject_edges;
  }

  PatchImage run() {
    const auto rows = static_cast<std::size_t>(height_);
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      Columns columns(static_cast<std::size_t>(width_ * side_));
      for (std::size_t y = begin; y < end; ++y) average_row(static_cast<int>(y), columns);
    });
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) slope_row(static_cast<int>(y));
    });
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      Planes planes(static_cast<std::size_t>(width_));
      for (std::size_t y = begin; y < end; ++y) plane_row(static_cast<int>(y), planes);
    });
    return std::move(result_);
  }

 private:
  // Into the padded arrays; x and y from -1.
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y + 1) * stride_ + static_cast<std::size_t>(x + 1); }
  bool valid(float z) const { return (z > 0.0f) & (z <= max_depth_); }

  void average_row(int y, Columns& c) {
    const int rows = std::min(side_, intrinsics_.height - side_ * y), width = intrinsics_.width;
    const float* const line = frame_.depth.ptr<float>(side_ * y);
    const std::size_t stride = frame_.depth.step1();
    const auto first = static_cast<float>(side_ * y);
    if (rows == 4) {
      sum_columns<4>(line, stride, rows, width, first, max_depth_, c);
    } else {
      sum_columns<0>(line, stride, rows, width, first, max_depth_, c);
    }
    const float full = 1.0f / static_cast<float>(side_ * side_);
    SurfacePatch* const patches = result_.patches.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = 0; x < width_; ++x) {
      float count = 0.0f, w = 0.0f, u_sum = 0.0f, v_sum = 0.0f, nearest = kFar, farthest = 0.0f;
      for (int i = 0; i < side_; ++i) {
        const auto u = static_cast<std::size_t>(x * side_ + i);
        count += c.count[u];
        w += c.w[u];
        u_sum += c.count[u] * static_cast<float>(i);
        v_sum += c.v[u];
        nearest = std::min(nearest, c.nearest[u]);
        farthest = std::max(farthest, c.farthest[u]);
      }
      if (count < least_count_) continue;
      const std::size_t i = at(x, y);
      const float tolerance = farthest * (steep_share_ * static_cast<float>(side_) + kPixelNoise * noise_);
      float from = 0.0f, to = kFar;
      const bool mixed = farthest - nearest > tolerance;
      if (mixed) {
        const float middle = 0.5f * (nearest + farthest);
        if (!take_larger_part(x, y, middle, i)) continue;
        (1.0f / means_.w[i] < middle ? to : from) = middle;
      } else {
        const float scale = 1.0f / count;
        means_.w[i] = w * scale;
        means_.u[i] = static_cast<float>(x * side_) + u_sum * scale;
        means_.v[i] = v_sum * scale;
        means_.spread[i] = farthest - nearest;
        means_.share[i] = count * full;
      }
      means_.known[i] = 1.0f;
      paint(x, y, mixed, from, to, patches[x]);
      if (!labels_.empty()) patches[x].label = label_of(x, y, from, to);
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
  bool take_larger_part(int x, int y, float middle, std::size_t i) {
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
    if (p.count < least_count_) return false;
    const float scale = 1.0f / p.count;
    means_.w[i] = p.w * scale;
    means_.u[i] = p.u * scale;
    means_.v[i] = p.v * scale;
    means_.spread[i] = p.farthest - p.nearest;
    means_.share[i] = p.count / static_cast<float>(side_ * side_);
    return true;
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

  void slope_row(int y) {
    const float per_patch = noise_ / static_cast<float>(side_);
    const std::size_t i = at(0, y);
    const auto row = [&](std::size_t place, const std::vector<float>& pixel) {
      return Side{means_.w.data() + place, pixel.data() + place};
    };
    float* const known = means_.known.data() + i;
    slopes_between(row(i - 1, means_.u), row(i, means_.u), row(i + 1, means_.u), per_patch, width_, means_.slope_u.data() + i, known);
    slopes_between(row(i - stride_, means_.v), row(i, means_.v), row(i + stride_, means_.v), per_patch, width_, means_.slope_v.data() + i,
                   known);
  }

  // Slopes of a row, averaged over the neighbours on the same plane, and how many these are.
  struct Planes {
    explicit Planes(std::size_t width) : u(width), v(width), friends(width) {}
    std::vector<float> u, v, friends;
  };

  void average_slopes(int y, Planes& out) const {
    const std::size_t i = at(0, y);
    const float *const w = means_.w.data() + i, *const u = means_.u.data() + i, *const v = means_.v.data() + i;
    const float *const su = means_.slope_u.data() + i, *const sv = means_.slope_v.data() + i;
    float *const sum_u = out.u.data(), *const sum_v = out.v.data(), *const friends = out.friends.data();
    std::copy_n(su, width_, sum_u);
    std::copy_n(sv, width_, sum_v);
    std::fill(out.friends.begin(), out.friends.end(), 0.0f);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const std::size_t j = at(dx, y + dy);
        const float *const ow = means_.w.data() + j, *const ou = means_.u.data() + j, *const ov = means_.v.data() + j;
        const float *const osu = means_.slope_u.data() + j, *const osv = means_.slope_v.data() + j, *const known = means_.known.data() + j;
        for (int x = 0; x < width_; ++x) {
          const float expected = w[x] + su[x] * (ou[x] - u[x]) + sv[x] * (ov[x] - v[x]);
          const bool same = (known[x] > 0.0f) & (std::abs(ow[x] - expected) <= noise_ * w[x]);
          sum_u[x] += same ? osu[x] : 0.0f;
          sum_v[x] += same ? osv[x] : 0.0f;
          friends[x] += same ? 1.0f : 0.0f;
        }
      }
    }
  }

  void plane_row(int y, Planes& planes) {
    average_slopes(y, planes);
    const auto fx = static_cast<float>(intrinsics_.fx), fy = static_cast<float>(intrinsics_.fy);
    const auto cx = static_cast<float>(intrinsics_.cx), cy = static_cast<float>(intrinsics_.cy);
    SurfacePatch* const patches = result_.patches.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = 0; x < width_; ++x) {
      const std::size_t i = at(x, y);
      if (means_.known[i] <= 0.0f) continue;
      const auto k = static_cast<std::size_t>(x);
      const float w = means_.w[i], depth = 1.0f / w, scale = 1.0f / (planes.friends[k] + 1.0f);
      const float su = planes.u[k] * scale, sv = planes.v[k] * scale;
      if (reject_edges_) {
        const float sloped = (std::abs(su) + std::abs(sv)) * static_cast<float>(side_) * depth * depth;
        if (planes.friends[k] < 2.0f || means_.spread[i] > sloped + kPixelNoise * noise_ * depth) continue;
      }
      const float qx = su * fx, qy = sv * fy, qz = w + su * (cx - means_.u[i]) + sv * (cy - means_.v[i]);
      const float h = 1.0f / std::sqrt(qx * qx + qy * qy + qz * qz);
      const float rx = (means_.u[i] - cx) / fx, ry = (means_.v[i] - cy) / fy;
      const float cosine = h * w / std::sqrt(rx * rx + ry * ry + 1.0f);
      if (!(cosine >= least_cosine_)) continue;
      SurfacePatch& patch = patches[x];
      patch.depth = depth;
      patch.weight = means_.share[i] * (config_.inverse_square_weight ? w * w : 1.0f);
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
  int side_ = 0, width_ = 0, height_ = 0;
  std::size_t stride_ = 0;
  float max_depth_ = 0.0f, noise_ = 0.0f, steep_share_ = 0.0f, least_cosine_ = 0.0f, least_count_ = 1.0f;
  bool reject_edges_ = true;
  Means means_;
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
