#include "sim/guided_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/parallel.h"

namespace waretwin {

namespace {

int component(std::uint32_t packed, int shift) { return static_cast<std::int8_t>(packed >> shift & 0xff); }

bool alike(float depth_p, float tolerance_p, std::uint32_t normal_p, float depth_q, std::uint32_t normal_q, int steps) {
  if (std::abs(depth_q - depth_p) > tolerance_p * static_cast<float>(steps)) return false;
  if (normal_p == normal_q) return true;
  const int dot = component(normal_p, 0) * component(normal_q, 0) + component(normal_p, 8) * component(normal_q, 8) +
                  component(normal_p, 16) * component(normal_q, 16);
  return dot > 14516;  // cosine 0.9 of 127^2
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

void smooth(const SurfaceGuide& guide, int radius, std::vector<float>& values, std::vector<float>& scratch) {
  scratch.resize(values.size());
  const int width = guide.width, height = guide.height;
  const auto pass = [&](const std::vector<float>& in, std::vector<float>& out, bool along_rows) {
    parallel_for(static_cast<std::size_t>(height), kRows, [&](std::size_t begin, std::size_t end) {
      const std::ptrdiff_t stride = along_rows ? 1 : width;
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        for (int x = 0; x < width; ++x) {
          const std::size_t p = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
          const float depth = guide.depth[p];
          if (depth == 0.0f) {
            out[p] = in[p];
            continue;
          }
          const float tolerance = guide.tolerance[p];
          const std::uint32_t normal = guide.normal[p];
          const int at = along_rows ? x : y, last = (along_rows ? width : height) - 1;
          const int low = -std::min(radius, at), high = std::min(radius, last - at);
          float sum = 0.0f, count = 0.0f;
          for (int k = low; k <= high; ++k) {
            const std::size_t q = p + static_cast<std::size_t>(k * stride);
            if (in[q] < 0.0f || !alike(depth, tolerance, normal, guide.depth[q], guide.normal[q], std::abs(k))) continue;
            sum += in[q];
            count += 1.0f;
          }
          out[p] = count > 0.0f ? sum / count : along_rows ? kUnknown : 1.0f;
        }
      }
    });
  };
  pass(values, scratch, true);
  pass(scratch, values, false);
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
