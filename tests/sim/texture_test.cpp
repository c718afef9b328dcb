#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sensors/tone_curve.h"
#include "sim/texture_sampler.h"

namespace waretwin {
namespace {

// Red grows with x, green with y: value = 16 * index.
Texture ramp(int width, int height) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int value : {16 * x, 16 * y, 0, 255}) texture.rgba.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return texture;
}

TEST(TextureSampler, BilinearBetweenTexelCentres) {
  const TextureSampler sampler(ramp(8, 4), TextureSampler::Encoding::kLinear);
  // A ramp is reproduced exactly between the first and the last centre; row 0 is the top, v = 0.
  for (const double x : {0.5, 1.0, 2.25, 7.5}) {
    for (const double y : {0.5, 1.75, 3.5}) {
      const Eigen::Vector4f value = sampler.sample({static_cast<float>(x / 8), static_cast<float>(y / 4)}, 0.0f);
      EXPECT_NEAR(value.x() * 255, 16 * (x - 0.5), 1e-3);
      EXPECT_NEAR(value.y() * 255, 16 * (y - 0.5), 1e-3);
    }
  }
}

TEST(TextureSampler, WrapModes) {
  Texture texture = ramp(8, 4);
  texture.nearest = true;
  const auto red = [&texture](float u) {
    return static_cast<int>(std::lround(TextureSampler(texture, TextureSampler::Encoding::kLinear).sample({u, 0.1f}, 0.0f).x() * 255 / 16));
  };
  const float u = 2.5f / 8;  // texel 2
  EXPECT_EQ(red(u), 2);
  EXPECT_EQ(red(u + 3), 2);
  EXPECT_EQ(red(u - 5), 2);
  texture.wrap_u = Texture::Wrap::kMirroredRepeat;
  EXPECT_EQ(red(u + 1), 5);
  EXPECT_EQ(red(-u), 2);
  EXPECT_EQ(red(u + 2), 2);
  texture.wrap_u = Texture::Wrap::kClampToEdge;
  EXPECT_EQ(red(u + 1), 7);
  EXPECT_EQ(red(-u), 0);
  EXPECT_EQ(red(std::numeric_limits<float>::infinity()), 0);
}

// Which texel stands for the i-th of a row, by counting.
int texel_at(long i, long size, Texture::Wrap wrap) {
  if (wrap == Texture::Wrap::kClampToEdge) return static_cast<int>(std::clamp(i, 0L, size - 1));
  const long period = wrap == Texture::Wrap::kRepeat ? size : 2 * size;
  const long m = ((i % period) + period) % period;
  return static_cast<int>(m < size ? m : 2 * size - 1 - m);
}

TEST(TextureSampler, WrapsLikeCountingTexels) {
  for (const auto wrap : {Texture::Wrap::kRepeat, Texture::Wrap::kMirroredRepeat, Texture::Wrap::kClampToEdge}) {
    for (const int size : {8, 7, 1}) {
      Texture texture = ramp(size, 1);
      texture.wrap_u = wrap;
      const TextureSampler sampler(texture, TextureSampler::Encoding::kLinear);
      for (int step = -400; step <= 400; ++step) {
        const double u = step / 64.0 + 1e-4;
        const double at = u * size - 0.5, left = std::floor(at);
        const double a = 16 * texel_at(std::lround(left), size, wrap), b = 16 * texel_at(std::lround(left) + 1, size, wrap);
        const double expected = a + (at - left) * (b - a);
        EXPECT_NEAR(sampler.sample({static_cast<float>(u), 0.5f}, 0.0f).x() * 255, expected, 0.01) << u << " of " << size;
      }
    }
  }
}

TEST(TextureSampler, SrgbRoundTripAndAverageOfLight) {
  for (int i = 0; i < 256; ++i) EXPECT_EQ(srgb_from_linear(linear_from_srgb(static_cast<std::uint8_t>(i))), i);
  // A fine chequer of black and white averages to half the light, not to half the stored number.
  Texture chequer;
  chequer.width = chequer.height = 64;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto value = static_cast<std::uint8_t>((x + y) % 2 * 255);
      for (const std::uint8_t v : {value, value, value, std::uint8_t{255}}) chequer.rgba.push_back(v);
    }
  }
  EXPECT_NEAR(TextureSampler(chequer, TextureSampler::Encoding::kSrgb).sample({0.3f, 0.7f}, 0.25f).x(), 0.5, 0.01);
}

TEST(TextureSampler, AlphaAtFullSize) {
  Texture texture = ramp(2, 1);
  texture.rgba[3] = 0;
  EXPECT_FLOAT_EQ(sample_alpha(texture, {0.25f, 0.5f}), 0.0f);
  EXPECT_FLOAT_EQ(sample_alpha(texture, {0.5f, 0.5f}), 0.5f);
  EXPECT_FLOAT_EQ(sample_alpha(texture, {0.75f, 0.5f}), 1.0f);
}

}  // namespace
}  // namespace waretwin
