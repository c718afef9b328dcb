#include "sim/guided_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/parallel.h"

namespace waretwin {

namespace {

int component(std::uint32_t packed, int shift) { return static_cast<std::int8_t>(packed >> shift & 0xff); }

constexpr int kAlikeNormals = 14516;  // cosine 0.9, of 127^2

bool alike(float depth_p, float tolerance_p, std::uint32_t normal_p, float depth_q, std::uint32_t normal_q, int steps) {
  if (std::abs(depth_q - depth_p) > tolerance_p * static_cast<float>(steps)) return false;
  if (normal_p == normal_q) return true;
  const int dot = component(normal_p, 0) * component(normal_q, 0) + component(normal_p, 8) * component(normal_q, 8) +
                  component(normal_p, 16) * component(normal_q, 16);
  return dot > kAlikeNormals;
}

constexpr std::size_t kRows = 8;

}  // namespace

void SurfaceGuide::resize(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  depth.resize(count);
  tolerance.resize(count);
  normal.resize(count);
}

std::uint32_t packed_normal(float x, float y, float z) {
  const auto pack = [](float c) {
    return static_cast<std::uint32_t>(static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lrintf(c * 127.0f))));
  };
  return pack(x) | pack(y) << 8 | pack(z) << 16;
}

bool same_surface(const SurfaceGuide& guide, std::size_t p, std::size_t q, int steps) {
  return alike(guide.depth[p], guide.tolerance[p], guide.normal[p], guide.depth[q], guide.normal[q], steps);
}

namespace {

// Four pixels at once, by the compilers' vector extension (GCC and Clang). Comparisons give 0 or all ones in each lane.
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));
constexpr int kLanes = 4;

template <class Lanes, class Element>
Lanes load(const Element* from) {
  static_assert(sizeof(Lanes) == kLanes * sizeof(Element));
  Lanes out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
bool any(const Ints& mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }

// component() lane by lane.
Ints components(const Ints& packed, int shift) { return packed << (24 - shift) >> 24; }

// One pass along rows (stride 1) or along columns (stride = width).
struct Pass {
  const SurfaceGuide& guide;
  const std::vector<float>& in;
  std::vector<float>& out;
  int radius;
  bool along_rows;

  std::ptrdiff_t stride() const { return along_rows ? 1 : guide.width; }
  float when_none_is_known() const { return along_rows ? kUnknown : 1.0f; }
  float weight(int k) const { return std::abs(k) == radius ? 0.5f : 1.0f; }

  // Mean over the neighbours from `low` to `high` steps away.
  void filter(std::size_t p, int low, int high) const {
    const float depth = guide.depth[p], tolerance = guide.tolerance[p];
    const std::uint32_t normal = guide.normal[p];
    if (depth == 0.0f) {
      out[p] = in[p];
      return;
    }
    bool dark = false;
    float sum = 0.0f, count = 0.0f;
    for (int k = low; k <= high; ++k) {
      const std::size_t q = p + static_cast<std::size_t>(k * stride());
      if (in[q] < 0.0f) continue;
      dark = dark || in[q] < 1.0f;
      if (!alike(depth, tolerance, normal, guide.depth[q], guide.normal[q], std::abs(k))) continue;
      sum += weight(k) * in[q];
      count += weight(k);
    }
    out[p] = !dark ? 1.0f : count > 0.0f ? sum / count : when_none_is_known();
  }

  // filter() for the pixels p to p + 3, given which of them have dark neighbours.
  void filter_lanes(std::size_t p, int low, int high, const Ints& dark) const {
    const Floats depth = load<Floats>(&guide.depth[p]), tolerance = load<Floats>(&guide.tolerance[p]), own = load<Floats>(&in[p]);
    const Ints normal = load<Ints>(&guide.normal[p]);
    const Ints nx = components(normal, 0), ny = components(normal, 8), nz = components(normal, 16);
    Floats sum{}, count{};
    for (int k = low; k <= high; ++k) {
      const std::size_t q = p + static_cast<std::size_t>(k * stride());
      const Floats value = load<Floats>(&in[q]);
      const Floats step = load<Floats>(&guide.depth[q]) - depth, allowed = tolerance * static_cast<float>(std::abs(k));
      const Ints other = load<Ints>(&guide.normal[q]);
      const Ints dot = nx * components(other, 0) + ny * components(other, 8) + nz * components(other, 16);
      const Ints counts = (value >= 0.0f) & (step <= allowed) & (-step <= allowed) & ((normal == other) | (dot > kAlikeNormals));
      const Floats share = counts ? Floats{} + weight(k) : Floats{};
      sum += share * value;
      count += share;
    }
    const Floats mean = count > 0.0f ? sum / (count > 0.0f ? count : Floats{} + 1.0f) : Floats{} + when_none_is_known();
    const Floats result = depth == 0.0f ? own : (dark ? mean : Floats{} + 1.0f);
    std::memcpy(&out[p], &result, sizeof result);
  }

  // Which of the pixels p to p + 3 have a neighbour, on whatever surface, that is known to be below 1.
  Ints dark_near(std::size_t p, int low, int high) const {
    Ints dark{};
    for (int k = low; k <= high; ++k) {
      const Floats value = load<Floats>(&in[p + static_cast<std::size_t>(k * stride())]);
      dark |= (value >= 0.0f) & (value < 1.0f);
    }
    return dark;
  }

  void rows(int begin, int end) const {
    for (int y = begin; y < end; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(guide.width);
      for (int x = 0; x < guide.width;) {
        const std::size_t p = row + static_cast<std::size_t>(x);
        const int at = along_rows ? x : y, last = (along_rows ? guide.width : guide.height) - 1;
        const int low = -std::min(radius, at), high = std::min(radius, last - at);
        const bool lanes_fit = along_rows ? x >= radius && x + kLanes - 1 + radius < guide.width : x + kLanes <= guide.width;
        if (!lanes_fit) {
          filter(p, low, high);
          ++x;
          continue;
        }
        // Most of a picture lies far from any shadow.
        if (const Ints dark = dark_near(p, low, high); any(dark)) {
          filter_lanes(p, low, high, dark);
        } else {
          std::fill_n(&out[p], kLanes, 1.0f);
        }
        x += kLanes;
      }
    }
  }
};

}  // namespace

void smooth(const SurfaceGuide& guide, int radius, std::vector<float>& values, std::vector<float>& scratch) {
  scratch.resize(values.size());
  for (const Pass& pass : {Pass{guide, values, scratch, radius, true}, Pass{guide, scratch, values, radius, false}}) {
    parallel_for(static_cast<std::size_t>(guide.height), kRows,
                 [&pass](std::size_t begin, std::size_t end) { pass.rows(static_cast<int>(begin), static_cast<int>(end)); });
  }
}

float upsampled(const SurfaceGuide& full, const SurfaceGuide& half, const std::vector<float>& half_values, int x, int y) {
  const std::size_t p = static_cast<std::size_t>(y) * static_cast<std::size_t>(full.width) + static_cast<std::size_t>(x);
  const int hx = x / 2, hy = y / 2;
  const int nx = std::min(hx + (x & 1), half.width - 1), ny = std::min(hy + (y & 1), half.height - 1);
  const auto at = [&half](int i, int j) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(half.width) + static_cast<std::size_t>(i);
  };
  const std::size_t q[4] = {at(hx, hy), at(nx, hy), at(hx, ny), at(nx, ny)};
  float sum = 0.0f, count = 0.0f;
  for (const std::size_t i : q) {
    if (!alike(full.depth[p], full.tolerance[p], full.normal[p], half.depth[i], half.normal[i], 2)) continue;
    sum += half_values[i];
    count += 1.0f;
  }
  return count > 0.0f ? sum / count : half_values[q[0]];
}

}  // namespace waretwin
