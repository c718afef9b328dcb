#include "sensors/tone_curve.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace waretwin {

namespace {

// The table's index is a number's exponent and the first bits of its mantissa: steps of 1/1024 of the value, whatever its size, and no
// root or logarithm to find them. Below kBlack the curve gives 0, at kWhite and above 255.
constexpr float kBlack = 0x1p-16f, kWhite = 16.0f;
constexpr int kDroppedBits = 13;
constexpr std::uint32_t index_of(float radiance) { return std::bit_cast<std::uint32_t>(radiance) >> kDroppedBits; }
constexpr std::uint32_t kFirst = index_of(kBlack);
constexpr std::size_t kSteps = index_of(kWhite) - kFirst;

double filmic(double x) {
  // 0.6 is the fit's own scale to ACES's middle grey.
  x *= 0.6;
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// Each step by its middle value.
std::array<std::uint8_t, kSteps> make_table() {
  std::array<std::uint8_t, kSteps> table{};
  for (std::size_t i = 0; i < kSteps; ++i) {
    const std::uint32_t middle = (static_cast<std::uint32_t>(i + kFirst) << kDroppedBits) + (1u << (kDroppedBits - 1));
    table[i] = srgb_from_linear(static_cast<float>(filmic(static_cast<double>(std::bit_cast<float>(middle)))));
  }
  return table;
}

const std::array<std::uint8_t, kSteps> kTable = make_table();

inline std::uint8_t looked_up(float radiance) {
  if (!(radiance > kBlack)) return 0;
  if (radiance >= kWhite) return 255;
  return kTable[index_of(radiance) - kFirst];
}

}  // namespace

std::uint8_t srgb_from_linear(float value) {
  const double x = std::clamp(static_cast<double>(value), 0.0, 1.0);
  const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(s * 255.0));
}

std::uint8_t tone_mapped(float radiance) { return looked_up(radiance); }

void tone_mapped(const float* radiances, std::size_t count, std::uint8_t* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = looked_up(radiances[i]);
}

}  // namespace waretwin
