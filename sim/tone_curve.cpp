#include "sim/tone_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/texture_sampler.h"

namespace waretwin {

namespace {

constexpr float kWhite = 16.0f;
constexpr int kSteps = 8192;

double filmic(double x) {
  // 0.6 is the fit's own scale to ACES's middle grey.
  x *= 0.6;
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// Indexed by the square root of radiance, so that dark values get their share of steps.
std::array<std::uint8_t, kSteps + 1> make_table() {
  std::array<std::uint8_t, kSteps + 1> table{};
  for (int i = 0; i <= kSteps; ++i) {
    const double root = static_cast<double>(i) / kSteps;
    table[static_cast<std::size_t>(i)] = srgb_from_linear(static_cast<float>(filmic(root * root * static_cast<double>(kWhite))));
  }
  return table;
}

}  // namespace

std::uint8_t tone_mapped(float radiance) {
  static const std::array<std::uint8_t, kSteps + 1> table = make_table();
  if (!(radiance > 0.0f)) return 0;
  const float root = std::sqrt(std::min(radiance, kWhite) / kWhite);
  return table[static_cast<std::size_t>(root * static_cast<float>(kSteps) + 0.5f)];
}

}  // namespace waretwin
