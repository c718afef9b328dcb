#include "sensors/depth_noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "sensors/depth_field.h"

namespace waretwin {

namespace {

// Pixels that share one pass through the loops below: small enough for the first-level cache.
constexpr std::size_t kBlock = 512;
constexpr std::size_t kPiece = 32 * kBlock;

// Natural logarithm of a positive normal float: exponent apart, mantissa in [sqrt(1/2), sqrt(2)) as 2 atanh((m - 1) / (m + 1)).
// Relative error below 1e-6; unlike libm's it is the same on every CPU and goes into vector registers.
inline float fast_log(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;
  const auto m = std::bit_cast<float>(bits - (exponent << 23));
  const float t = (m - 1.0f) / (m + 1.0f);
  const float t2 = t * t;
  const float series = 1.0f + t2 * (1.0f / 3.0f + t2 * (1.0f / 5.0f + t2 * (1.0f / 7.0f + t2 * (1.0f / 9.0f))));
  return static_cast<float>(exponent) * 0.6931471806f + 2.0f * t * series;
}

// Standard normal from 32 random bits through the inverse error function (Giles, "Approximating the erfinv function", GPU Computing
// Gems 2011, single precision). The random word is folded at one half first, so that the lower tail keeps all its digits.
struct FoldedUniform {
  float tail;  // in (0, 1/2]: probability beyond the value
  float sign;
};

inline FoldedUniform folded(std::uint32_t word) {
  const auto low = static_cast<std::int32_t>(word & 0x7fffffffu);
  return {(static_cast<float>(low) + 0.5f) * 0x1p-32f, word & 0x80000000u ? 1.0f : -1.0f};
}

inline float central_normal(float w, float x) {
  w -= 2.5f;
  float p = 2.81022636e-08f;
  p = 3.43273939e-07f + p * w;
  p = -3.5233877e-06f + p * w;
  p = -4.39150654e-06f + p * w;
  p = 0.00021858087f + p * w;
  p = -0.00125372503f + p * w;
  p = -0.00417768164f + p * w;
  p = 0.246640727f + p * w;
  p = 1.50140941f + p * w;
  return 1.41421356f * p * x;
}

float tail_normal(float w, float x) {
  w = std::sqrt(w) - 3.0f;
  float p = -0.000200214257f;
  p = 0.000100950558f + p * w;
  p = 0.00134934322f + p * w;
  p = -0.00367342844f + p * w;
  p = 0.00573950773f + p * w;
  p = -0.0076224613f + p * w;
  p = 0.00943887047f + p * w;
  p = 1.00167406f + p * w;
  p = 2.83297682f + p * w;
  return 1.41421356f * p * x;
}

void normals(const std::uint32_t* words, std::size_t count, float* out) {
  std::array<float, kBlock> w;
  std::array<float, kBlock> x;
  for (std::size_t i = 0; i < count; ++i) {
    const FoldedUniform u = folded(words[i]);
    w[i] = -fast_log(4.0f * u.tail * (1.0f - u.tail));
    x[i] = u.sign * (1.0f - 2.0f * u.tail);
    out[i] = central_normal(w[i], x[i]);
  }
  // Beyond 2.7 standard deviations, less than one pixel in a hundred.
  for (std::size_t i = 0; i < count; ++i) {
    if (w[i] >= 5.0f) out[i] = tail_normal(w[i], x[i]);
  }
}

// The nearest whole number to x in [0, 2^22), ties to even, as std::nearbyint would give it.
inline float rounded(float x) {
  constexpr float kShift = 12582912.0f;
  return (x + kShift) - kShift;
}

}  // namespace

DepthNoiseModel::DepthNoiseModel(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor)
    : camera_(camera), seed_(seed), sensor_(sensor), field_(depth_field_mask(camera)) {}

void DepthNoiseModel::apply(cv::Mat& depth, Stamp stamp) const {
  WARETWIN_CHECK(depth.type() == CV_32FC1 && depth.isContinuous(), "depth is a continuous image of 32-bit floats");
  WARETWIN_CHECK(depth.size() == field_.size(), "depth has the size of the camera's image");
  const RandomStream random(seed_, sensor_, "depth_noise", stamp);
  auto* const pixels = depth.ptr<float>();
  const auto* const field = field_.ptr<std::uint8_t>();
  const bool noisy = camera_.noise.enabled;
  const auto base = static_cast<float>(camera_.noise.sigma_base_m);
  const auto growth = static_cast<float>(camera_.noise.sigma_per_m2);
  const auto dropped_below = static_cast<std::uint64_t>(std::ldexp(noisy ? camera_.noise.dropout_share : 0.0, 32));
  const auto shortest = static_cast<float>(std::ceil(camera_.depth_min_m * 1000.0 - 1e-6));
  const auto longest = static_cast<float>(std::min(std::floor(camera_.depth_max_m * 1000.0 + 1e-6), 65535.0));

  parallel_for(depth.total(), kPiece, [&](std::size_t begin, std::size_t end) {
    std::array<std::array<std::uint32_t, 4>, kBlock / 2> words;
    std::array<std::uint32_t, kBlock> normal_words;
    std::array<std::uint32_t, kBlock> dropout_words{};
    std::array<float, kBlock> normal{};
    for (std::size_t first = begin; first < end; first += kBlock) {
      const std::size_t count = std::min(kBlock, end - first);
      if (noisy) {
        // One call of the generator serves two neighbouring pixels. Blocks begin at even pixels.
        random.fill(first / 2, (count + 1) / 2, words.data());
        for (std::size_t i = 0; i < count; ++i) {
          normal_words[i] = words[i / 2][i % 2];
          dropout_words[i] = words[i / 2][2 + i % 2];
        }
        normals(normal_words.data(), count, normal.data());
      }
      for (std::size_t i = 0; i < count; ++i) {
        const float z = pixels[first + i];
        // A sum of this size rounds without loss; NaN and infinity fail the comparisons.
        const float sigma = noisy ? base + growth * z * z : 0.0f;
        const float reading = rounded((z + sigma * normal[i]) * 1000.0f);
        const bool valid =
            (z > 0.0f) & (reading >= shortest) & (reading <= longest) & (field[first + i] != 0) & (dropout_words[i] >= dropped_below);
        pixels[first + i] = valid ? reading * 0.001f : 0.0f;
      }
    }
  });
}

}  // namespace waretwin
