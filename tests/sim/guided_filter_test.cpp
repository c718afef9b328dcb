#include "sim/guided_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace waretwin {
namespace {

// A wall that steps by a metre at a slanted line, with a fold in it, a hole, and values of 0, 1 and unknown.
struct Picture {
  SurfaceGuide guide;
  std::vector<float> values;

  Picture(int width, int height, double unknown_share, double dark_share) {
    guide.resize(width, height);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto p = static_cast<std::size_t>(y * width + x);
        guide.depth[p] = 2.0f + 0.002f * static_cast<float>(x) + (3 * x > 2 * y + width ? 1.0f : 0.0f);
        if (x > width / 3 && x < width / 3 + 5 && y > 3 && y < 8) guide.depth[p] = 0.0f;
        guide.tolerance[p] = guide.depth[p] == 0.0f ? 0.0f : 0.004f;
        guide.normal[p] = y < height / 2 ? packed_normal(0, 0, -1) : packed_normal(0, -1, 0);
        values.push_back(uniform(random) < unknown_share ? kUnknown : uniform(random) < dark_share && y > height / 4 ? 0.0f : 1.0f);
        if (guide.depth[p] == 0.0f) values.back() = 1.0f;
      }
    }
  }
};

// The definition, pixel by pixel.
std::vector<float> pass_by_definition(const SurfaceGuide& guide, int radius, const std::vector<float>& in, bool along_rows) {
  std::vector<float> out(in.size());
  for (int y = 0; y < guide.height; ++y) {
    for (int x = 0; x < guide.width; ++x) {
      const auto p = static_cast<std::size_t>(y * guide.width + x);
      float sum = 0.0f, known = 0.0f;
      bool dark = false;
      for (int k = -radius; k <= radius; ++k) {
        const int qx = along_rows ? x + k : x, qy = along_rows ? y : y + k;
        if (qx < 0 || qy < 0 || qx >= guide.width || qy >= guide.height) continue;
        const auto q = static_cast<std::size_t>(qy * guide.width + qx);
        if (in[q] < 0.0f) continue;
        dark = dark || in[q] < 1.0f;
        if (!same_surface(guide, p, q, std::abs(k))) continue;
        const float weight = std::abs(k) == radius ? 0.5f : 1.0f;
        sum += weight * in[q];
        known += weight;
      }
      out[p] = known > 0.0f ? sum / known : along_rows ? kUnknown : 1.0f;
      if (!dark) out[p] = 1.0f;
      if (guide.depth[p] == 0.0f) out[p] = in[p];
    }
  }
  return out;
}

TEST(GuidedFilter, IsItsDefinitionAtAnySize) {
  for (const auto& [width, height] : {std::pair(64, 40), std::pair(61, 37), std::pair(7, 5), std::pair(1, 9), std::pair(12, 1)}) {
    for (const int radius : {1, 3, 4}) {
      Picture picture(width, height, 0.5, 0.3);
      const std::vector<float> rows = pass_by_definition(picture.guide, radius, picture.values, true);
      const std::vector<float> expected = pass_by_definition(picture.guide, radius, rows, false);
      std::vector<float> scratch;
      smooth(picture.guide, radius, picture.values, scratch);
      for (std::size_t p = 0; p < expected.size(); ++p) {
        ASSERT_FLOAT_EQ(picture.values[p], expected[p]) << width << " x " << height << ", radius " << radius << ", pixel " << p;
      }
    }
  }
}

TEST(GuidedFilter, KeepsShadowsOnTheirSurface) {
  SurfaceGuide guide;
  guide.resize(32, 16);
  std::vector<float> values(guide.depth.size()), scratch;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const auto p = static_cast<std::size_t>(y * 32 + x);
      guide.depth[p] = x < 16 ? 1.0f : 2.0f;
      guide.tolerance[p] = 0.01f;
      guide.normal[p] = packed_normal(0, 0, -1);
      values[p] = x < 16 ? 0.0f : 1.0f;
    }
  }
  const std::vector<float> before = values;
  smooth(guide, 4, values, scratch);
  EXPECT_EQ(values, before);
}

}  // namespace
}  // namespace waretwin
