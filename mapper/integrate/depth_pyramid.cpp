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
  const Level& tiles = levels_[static_cast<std::size_t>(level)];
  const float per_pixel = 1.0f / static_cast<float>(4 << level);
  const auto tile = [&](float pixel, int count) {
    return std::clamp(static_cast<int>(std::floor((pixel + 0.5f) * per_pixel)), 0, count - 1);
  };
  const int x0 = tile(u - radius, tiles.width), x1 = tile(u + radius, tiles.width);
  const int y0 = tile(v - radius, tiles.height), y1 = tile(v + radius, tiles.height);
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
  for (int x = 0; x < base.width; ++x) {
    const int u1 = std::min(depth.cols, 4 * x + 4), v1 = std::min(depth.rows, 4 * row + 4);
    float smallest = kFar, largest = 0.0f;
    int valid = 0, all = 0;
    for (int v = 4 * row; v < v1; ++v) {
      const float* line = depth.ptr<float>(v);
      for (int u = 4 * x; u < u1; ++u) {
        const bool ok = line[u] > 0.0f;
        smallest = std::min(smallest, ok ? line[u] : kFar);
        largest = std::max(largest, ok ? line[u] : 0.0f);
        valid += ok;
        ++all;
      }
    }
    base.smallest[base.at(x, row)] = 2 * valid >= all ? smallest : 0.0f;
    base.largest[base.at(x, row)] = largest;
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
