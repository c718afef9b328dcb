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
constexpr float kGrowthVoxels = 2.0f;
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

// What follows are plain loops over a row, written so that compilers take several patches at once: no branches, conditions as factors of 0
// or 1, and no two names for one place.

constexpr float when(bool condition) { return condition ? 1.0f : 0.0f; }

// `rows` lines of depth from row `first` on.
template <int kRows>
void sum_columns(const float* __restrict line, std::size_t stride, int rows, int width, float first, float far, Columns& c) {
  const int lines = kRows > 0 ? kRows : rows;
  float* __restrict count = c.count.data(), * __restrict ws = c.w.data(), * __restrict vs = c.v.data();
  float* __restrict nearest = c.nearest.data(), * __restrict farthest = c.farthest.data();
  for (int u = 0; u < width; ++u) {
    float n = 0.0f, w = 0.0f, v = 0.0f, low = kFar, high = 0.0f;
    for (int r = 0; r < lines; ++r) {
      const float z = line[static_cast<std::size_t>(r) * stride + static_cast<std::size_t>(u)];
      const float ok = when(z > 0.0f) * when(z <= far);
      const float divisor = ok > 0.0f ? z : 1.0f;
      n += ok;
      w += ok / divisor;
      v += ok * (first + static_cast<float>(r));
      const float near_z = ok > 0.0f ? z : kFar, far_z = ok > 0.0f ? z : 0.0f;
      low = near_z < low ? near_z : low;
      high = far_z > high ? far_z : high;
    }
    count[u] = n;
    ws[u] = w;
    vs[u] = v;
    nearest[u] = low;
    farthest[u] = high;
  }
}

// Slopes from the two sides of each patch of a row: between both where they agree, of the flatter one where not; 0 and not known where
// there is neither. `place` is u or v.
struct Side {
  const float *w, *place;
};
void slopes_between(const Side& low, const Side& here, const Side& high, float per_patch, int width, float* __restrict slope,
                    float* __restrict known) {
  const float* __restrict w_low = low.w, * __restrict w_here = here.w, * __restrict w_high = high.w;
  const float* __restrict at_low = low.place, * __restrict at_here = here.place, * __restrict at_high = high.place;
  for (int x = 0; x < width; ++x) {
    const float l = w_low[x], h = w_here[x], u = w_high[x], x_l = at_low[x], x_h = at_here[x], x_u = at_high[x];
    const float has_l = when(l > 0.0f), has_u = when(u > 0.0f), both = has_l * has_u;
    const float step_l = x_h - x_l, step_u = x_u - x_h, step = x_u - x_l;
    const float below = (h - l) / (has_l > 0.0f ? step_l : 1.0f);
    const float above = (u - h) / (has_u > 0.0f ? step_u : 1.0f);
    const float across = (u - l) / (both > 0.0f ? step : 1.0f);
    const float flatter = std::abs(below) < std::abs(above) ? below : above;
    const float of_both = std::abs(below - above) <= h * per_patch ? across : flatter;
    const float of_one = has_l > 0.0f ? below : above;
    const float any = both > 0.0f ? of_both : of_one;
    const float sure = known[x] * when(l + u > 0.0f);
    slope[x] = sure > 0.0f ? any : 0.0f;
    known[x] = sure;
  }
}

// One row of patches, and the same row seen from a neighbour's side.
struct Row {
  const float *w, *u, *v, *slope_u, *slope_v, *known;
};

// Adds the slopes of the neighbours that lie on a patch's plane.
void add_friends(const Row& own, const Row& other, float noise, int width, float* __restrict sum_u, float* __restrict sum_v,
                 float* __restrict friends) {
  const float* __restrict w = own.w, * __restrict u = own.u, * __restrict v = own.v;
  const float* __restrict su = own.slope_u, * __restrict sv = own.slope_v;
  const float* __restrict other_w = other.w, * __restrict other_u = other.u, * __restrict other_v = other.v;
  const float* __restrict other_su = other.slope_u, * __restrict other_sv = other.slope_v, * __restrict known = other.known;
  for (int x = 0; x < width; ++x) {
    const float expected = w[x] + su[x] * (other_u[x] - u[x]) + sv[x] * (other_v[x] - v[x]);
    const float same = when(known[x] > 0.0f) * when(std::abs(other_w[x] - expected) <= noise * w[x]);
    sum_u[x] += same * other_su[x];
    sum_v[x] += same * other_sv[x];
    friends[x] += same;
  }
}

struct PlaneRules {
  float fx, fy, cx, cy;
  float side;                        // pixels along a patch
  float pixel_noise;                 // share of depth that one pixel may stray
  float least_friends, more_spread;  // metres
  float least_cosine;
  float by_range, by_incidence;  // 1: weighted by it
};

// From summed slopes (in nx and ny) to planes and weights; weight 0 where there is none.
void make_planes(const PlaneRules& rules, const Row& row, const float* __restrict spread, const float* __restrict share,
                 const float* __restrict friends, int width, float* __restrict nx, float* __restrict ny, float* __restrict nz,
                 float* __restrict hs, float* __restrict weight) {
  const PlaneRules c = rules;
  const float* __restrict ws = row.w, * __restrict us = row.u, * __restrict vs = row.v, * __restrict known = row.known;
  const float per_fx = 1.0f / c.fx, per_fy = 1.0f / c.fy;
  for (int x = 0; x < width; ++x) {
    const float there = known[x], inverse = ws[x];
    const float w = there > 0.0f ? inverse : 1.0f, depth = 1.0f / w, scale = 1.0f / (friends[x] + 1.0f);
    const float su = nx[x] * scale, sv = ny[x] * scale;
    const float sloped = (std::abs(su) + std::abs(sv)) * c.side * depth * depth;
    const float qx = su * c.fx, qy = sv * c.fy, qz = w + su * (c.cx - us[x]) + sv * (c.cy - vs[x]);
    const float h = 1.0f / std::sqrt(qx * qx + qy * qy + qz * qz);
    const float rx = (us[x] - c.cx) * per_fx, ry = (vs[x] - c.cy) * per_fy;
    const float cosine = h * w / std::sqrt(rx * rx + ry * ry + 1.0f);
    const float good = there * when(friends[x] >= c.least_friends) * when(spread[x] <= sloped + c.pixel_noise * depth + c.more_spread) *
                       when(cosine >= c.least_cosine);
    weight[x] = good * share[x] * (c.by_range > 0.0f ? w * w : 1.0f) * (c.by_incidence > 0.0f ? cosine : 1.0f);
    nx[x] = qx * h;
    ny[x] = qy * h;
    nz[x] = qz * h;
    hs[x] = h;
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
    result_.planes.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1);
    result_.patches.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1);
    max_depth_ = static_cast<float>(config.max_depth_m);
    noise_ = static_cast<float>(config.projection.depth_noise_share);
    const double steepest = to_radians(config.projection.max_incidence_deg);
    // Largest change of depth from pixel to pixel, as a share of depth.
    steep_share_ = static_cast<float>(std::tan(steepest) / std::min(intrinsics.fx, intrinsics.fy));
    farthest_growth_ = kGrowthVoxels * static_cast<float>(config.voxel_m);
    least_count_ = static_cast<float>(std::max(1, side_ * side_ / 4));
    const ProjectionConfig& p = config.projection;
    rules_ = {static_cast<float>(intrinsics.fx),  static_cast<float>(intrinsics.fy), static_cast<float>(intrinsics.cx),
              static_cast<float>(intrinsics.cy),  static_cast<float>(side_),         kPixelNoise * noise_,
              p.reject_edges ? 2.0f : 0.0f,       p.reject_edges ? 0.0f : kFar,      static_cast<float>(std::cos(steepest)),
              when(config.inverse_square_weight), when(p.incidence_weight)};
  }

  PatchImage run() {
    const auto rows = static_cast<std::size_t>(height_);
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      Columns columns(static_cast<std::size_t>(width_ * side_));
      for (std::size_t y = begin; y < end; ++y) {
        if (side_ == 4) {
          average_row<4>(static_cast<int>(y), columns);
        } else {
          average_row<0>(static_cast<int>(y), columns);
        }
      }
    });
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) slope_row(static_cast<int>(y));
    });
    parallel_for(rows, kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      Planes planes(static_cast<std::size_t>(width_));
      for (std::size_t y = begin; y < end; ++y) plane_row(static_cast<int>(y), planes);
    });
    if (config_.projection.grow_weight > 0.0) grow();
    return std::move(result_);
  }

 private:
  // Into the padded arrays; x and y from -1.
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y + 1) * stride_ + static_cast<std::size_t>(x + 1); }
  bool valid(float z) const { return (z > 0.0f) & (z <= max_depth_); }

  template <int kSide>
  void average_row(int y, Columns& c) {
    const int side = kSide > 0 ? kSide : side_;
    const int rows = std::min(side_, intrinsics_.height - side_ * y), width = intrinsics_.width;
    const float* const line = frame_.depth.ptr<float>(side_ * y);
    const std::size_t stride = frame_.depth.step1();
    const auto first = static_cast<float>(side_ * y);
    if (kSide > 0 && rows == kSide) {
      sum_columns<kSide>(line, stride, rows, width, first, max_depth_, c);
    } else {
      sum_columns<0>(line, stride, rows, width, first, max_depth_, c);
    }
    const float full = 1.0f / static_cast<float>(side_ * side_);
    SurfacePatch* const patches = result_.patches.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = 0; x < width_; ++x) {
      float count = 0.0f, w = 0.0f, u_sum = 0.0f, v_sum = 0.0f, nearest = kFar, farthest = 0.0f;
      for (int i = 0; i < side; ++i) {
        const auto u = static_cast<std::size_t>(x * side + i);
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
      if (!labels_.empty()) patches[x].label = label_of(x, y, from, to, side);
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
    if (count == 4) {
      patch.red = static_cast<std::uint8_t>((red + 2) >> 2);
      patch.green = static_cast<std::uint8_t>((green + 2) >> 2);
      patch.blue = static_cast<std::uint8_t>((blue + 2) >> 2);
      return;
    }
    patch.red = static_cast<std::uint8_t>((red + count / 2) / count);
    patch.green = static_cast<std::uint8_t>((green + count / 2) / count);
    patch.blue = static_cast<std::uint8_t>((blue + count / 2) / count);
  }

  std::int32_t label_of(int x, int y, float from, float to, int side) const {
    const int u0 = side * x, v0 = side * y;
    const bool whole = u0 + side <= intrinsics_.width && v0 + side <= intrinsics_.height;
    const auto row = [&](int v) { return labels_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(intrinsics_.width); };
    if (whole) {
      const std::int32_t first = row(v0)[u0];
      std::int32_t differs = 0;
      for (int v = 0; v < side; ++v) {
        const std::int32_t* const line = row(v0 + v) + u0;
        for (int u = 0; u < side; ++u) differs |= line[u] ^ first;
      }
      if (differs == 0) return first;
    }
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

  // Planes of a row; nx and ny hold summed slopes before.
  struct Planes {
    explicit Planes(std::size_t width) : nx(width), ny(width), nz(width), h(width), weight(width), friends(width) {}
    std::vector<float> nx, ny, nz, h, weight, friends;
  };

  Row row_at(std::size_t i) const {
    return {means_.w.data() + i,       means_.u.data() + i,       means_.v.data() + i,
            means_.slope_u.data() + i, means_.slope_v.data() + i, means_.known.data() + i};
  }

  void plane_row(int y, Planes& planes) {
    const std::size_t i = at(0, y);
    const Row own = row_at(i);
    std::copy_n(own.slope_u, width_, planes.nx.data());
    std::copy_n(own.slope_v, width_, planes.ny.data());
    std::fill(planes.friends.begin(), planes.friends.end(), 0.0f);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        add_friends(own, row_at(at(dx, y + dy)), noise_, width_, planes.nx.data(), planes.ny.data(), planes.friends.data());
      }
    }
    make_planes(rules_, own, means_.spread.data() + i, means_.share.data() + i, planes.friends.data(), width_, planes.nx.data(),
                planes.ny.data(), planes.nz.data(), planes.h.data(), planes.weight.data());
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    SurfacePatch* const patches = result_.patches.data() + first;
    const bool plane = config_.projection.plane_distance;
    for (int x = 0; x < width_; ++x) {
      const auto k = static_cast<std::size_t>(x);
      if (planes.weight[k] <= 0.0f) continue;
      SurfacePatch& patch = patches[x];
      patch.depth = 1.0f / own.w[x];
      patch.weight = planes.weight[k];
      patch.nx = plane ? planes.nx[k] : 0.0f;
      patch.ny = plane ? planes.ny[k] : 0.0f;
      patch.nz = plane ? planes.nz[k] : 1.0f;
      patch.h = plane ? planes.h[k] : patch.depth;
      result_.planes[first + k] = {patch.nx, patch.ny, patch.nz, patch.h};
    }
  }

  // A patch seen so flat or from so far that it covers more than two voxels would reach far over the rim.
  bool may_grow(const SurfacePatch& patch, int x, int y) const {
    const auto middle = 0.5f * static_cast<float>(side_ - 1);
    const float rx = (static_cast<float>(x * side_) + middle - rules_.cx) / rules_.fx;
    const float ry = (static_cast<float>(y * side_) + middle - rules_.cy) / rules_.fy;
    const float cosine = std::abs(patch.nx * rx + patch.ny * ry + patch.nz) / std::sqrt(rx * rx + ry * ry + 1.0f);
    return static_cast<float>(side_) * patch.depth / rules_.fx <= farthest_growth_ * cosine;
  }

  // The rims: patches without a surface get the nearest neighbour's, at a low weight.
  void grow() {
    struct Rim {
      std::size_t to, from;
    };
    constexpr std::array<std::array<int, 2>, 4> kBeside = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    // Found for the whole picture before any is filled, so that no surface grows twice.
    std::vector<std::vector<Rim>> pieces((static_cast<std::size_t>(height_) + kRowsPerPiece - 1) / kRowsPerPiece);
    const auto index = [&](int x, int y) {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    };
    parallel_for(static_cast<std::size_t>(height_), kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const auto y = static_cast<int>(row);
        for (int x = 0; x < width_; ++x) {
          if (result_.at(x, y).weight > 0.0f) continue;
          float nearest = kFar;
          Rim rim{index(x, y), 0};
          for (const auto& [dx, dy] : kBeside) {
            if (x + dx < 0 || x + dx >= width_ || y + dy < 0 || y + dy >= height_) continue;
            const SurfacePatch& beside = result_.at(x + dx, y + dy);
            if (beside.weight <= 0.0f || beside.depth >= nearest || !may_grow(beside, x + dx, y + dy)) continue;
            nearest = beside.depth;
            rim.from = index(x + dx, y + dy);
          }
          if (nearest < kFar) pieces[begin / kRowsPerPiece].push_back(rim);
        }
      }
    });
    const auto share = static_cast<float>(config_.projection.grow_weight);
    for (const std::vector<Rim>& piece : pieces) {
      for (const Rim& rim : piece) {
        SurfacePatch patch = result_.patches[rim.from];
        patch.weight *= share;
        result_.planes[rim.to] = {patch.nx, patch.ny, patch.nz, patch.h};
        result_.patches[rim.to] = patch;
      }
    }
  }

  const RgbdFrame& frame_;
  const Intrinsics& intrinsics_;
  const std::vector<std::int32_t>& labels_;
  const TsdfConfig& config_;
  int side_ = 0, width_ = 0, height_ = 0;
  std::size_t stride_ = 0;
  float max_depth_ = 0.0f, noise_ = 0.0f, steep_share_ = 0.0f, least_count_ = 1.0f, farthest_growth_ = 0.0f;
  PlaneRules rules_{};
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
