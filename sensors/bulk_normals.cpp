#include "sensors/bulk_normals.h"

#include <array>
#include <bit>
#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

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

}  // namespace

void normals_of_words(const std::uint32_t* words, std::size_t count, float* out) {
  WARETWIN_CHECK(count <= kNormalBlock, "a block of normals");
  std::array<float, kNormalBlock> w;
  std::array<float, kNormalBlock> x;
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

}  // namespace waretwin
