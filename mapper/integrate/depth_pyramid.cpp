#include "mapper/integrate/depth_pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace waretwin {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

}  // namespace

void DepthPyramid::Level::allocate() {
  smallest.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kFar);
  largest.assign(smallest.size(), 0.0f);
}

DepthPyramid::DepthPyramid(const cv::Mat& depth) {
  Level base;
  base.width = (depth.cols + 3) / 4;
  base.height = (depth.rows + 3) / 4;
  base.allocate();
  parallel_for(static_cast<std::size_t>(base.height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) base_row(depth, static_cast<int>(row), base);
  });
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse;
    coarse.width = (fine.width + 1) / 2;
    coarse.height = (fine.height + 1) / 2;
    coarse.allocate();
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        const std::size_t to = coarse.at(x / 2, y / 2), from = fine.at(x, y);
        coarse.smallest[to] = std::min(coarse.smallest[to], fine.smallest[from]);
        coarse.largest[to] = std::max(coarse.largest[to], fine.largest[from]);
      }
    }
    levels_.push_back(std::move(coarse));
  }
  parallel_for(levels_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) look_around(levels_[i]);
  });
}

DepthPyramid::Range DepthPyramid::range(float u, float v, float radius) const {
  int level = 0;
  while (level + 1 < static_cast<int>(levels_.size()) && static_cast<float>(4 << level) < 2.0f * radius) ++level;
  return range_at(level, u - radius, v - radius, u + radius, v + radius);
}

DepthPyramid::Range DepthPyramid::range(float u0, float v0, float u1, float v1) const {
  // Up to five tiles along an edge: finer ones hold less of what lies around.
  const float edge = 0.25f * std::max(u1 - u0, v1 - v0);
  int level = 0;
  while (level + 1 < static_cast<int>(levels_.size()) && static_cast<float>(4 << level) < edge) ++level;
  return range_at(level, u0, v0, u1, v1);
}

DepthPyramid::Range DepthPyramid::range_at(int level, float u0, float v0, float u1, float v1) const {
  const Level& tiles = levels_[static_cast<std::size_t>(level)];
  const float per_pixel = 1.0f / static_cast<float>(4 << level);
  const auto tile = [&](float pixel, int count) {
    return std::clamp(static_cast<int>(std::floor((pixel + 0.5f) * per_pixel)), 0, count - 1);
  };
  const int x0 = tile(u0, tiles.width), x1 = tile(u1, tiles.width);
  const int y0 = tile(v0, tiles.height), y1 = tile(v1, tiles.height);
  Range range;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      range.smallest = std::min(range.smallest, tiles.smallest[tiles.at(x, y)]);
      range.largest = std::max(range.largest, tiles.largest[tiles.at(x, y)]);
    }
  }
  return range;
}

DepthPyramid::Surroundings DepthPyramid::surroundings(float radius) const {
  std::size_t level = 0;
  while (level + 1 < levels_.size() && static_cast<float>(4 << level) < radius) ++level;
  const Level& tiles = levels_[level];
  return {tiles.width, tiles.height, 1.0f / static_cast<float>(4 << level), tiles.around.data()};
}

void DepthPyramid::base_row(const cv::Mat& depth, int row, Level& base) {
  // Down the rows first, per column of pixels.
  const int v0 = 4 * row, rows = std::min(4, depth.rows - v0), width = depth.cols;
  const auto columns = static_cast<std::size_t>(base.width) * 4;
  std::vector<float> lowest(columns, kFar), highest(columns, 0.0f), valid(columns, 0.0f);
  const float* const line = depth.ptr<float>(v0);
  const std::size_t stride = depth.step1();
  for (int r = 0; r < rows; ++r) {
    const float* const z = line + static_cast<std::size_t>(r) * stride;
    float *const low = lowest.data(), *const high = highest.data(), *const count = valid.data();
    for (int u = 0; u < width; ++u) {
      const bool ok = z[u] > 0.0f;
      const float near_z = ok ? z[u] : kFar, far_z = ok ? z[u] : 0.0f;
      low[u] = near_z < low[u] ? near_z : low[u];
      high[u] = far_z > high[u] ? far_z : high[u];
      count[u] += ok ? 1.0f : 0.0f;
    }
  }
  for (int x = 0; x < base.width; ++x) {
    const float all = static_cast<float>(rows * std::min(4, width - 4 * x));
    const auto u = static_cast<std::size_t>(4 * x);
    const float count = valid[u] + valid[u + 1] + valid[u + 2] + valid[u + 3];
    const float low = std::min(std::min(lowest[u], lowest[u + 1]), std::min(lowest[u + 2], lowest[u + 3]));
    base.smallest[base.at(x, row)] = 2.0f * count >= all ? low : 0.0f;
    base.largest[base.at(x, row)] = std::max(std::max(highest[u], highest[u + 1]), std::max(highest[u + 2], highest[u + 3]));
  }
}

void DepthPyramid::look_around(Level& level) {
  const auto width = static_cast<std::size_t>(level.width), height = static_cast<std::size_t>(level.height);
  std::vector<float> along(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const float* in = level.smallest.data() + y * width;
    float* out = along.data() + y * width;
    out[0] = width > 1 ? std::min(in[0], in[1]) : in[0];
    for (std::size_t x = 1; x + 1 < width; ++x) out[x] = std::min(std::min(in[x - 1], in[x]), in[x + 1]);
    if (width > 1) out[width - 1] = std::min(in[width - 2], in[width - 1]);
  }
  level.around.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const float* above = along.data() + (y > 0 ? y - 1 : y) * width;
    const float* here = along.data() + y * width;
    const float* below = along.data() + (y + 1 < height ? y + 1 : y) * width;
    float* out = level.around.data() + y * width;
    for (std::size_t x = 0; x < width; ++x) out[x] = std::min(std::min(above[x], here[x]), below[x]);
  }
}

}  // namespace waretwin
