// Random numbers for neighbouring pixels that a filter averages.
#pragma once

#include <cstdint>

#include "sim/pixel_random.h"

namespace waretwin {

// Pixels in Z-order: every aligned block of 2^n x 2^n pixels holds consecutive numbers.
inline std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 8) & 0x00ff00ffu;
  v = (v | v << 4) & 0x0f0f0f0fu;
  v = (v | v << 2) & 0x33333333u;
  return (v | v << 1) & 0x55555555u;
}
inline std::uint32_t z_order(int x, int y) {
  return spread_bits(static_cast<std::uint32_t>(x)) | spread_bits(static_cast<std::uint32_t>(y)) << 1;
}

// Well spread points for neighbouring pixels: the k-th point of a rank-1 sequence in three dimensions (M. Roberts, "The unreasonable
// effectiveness of quasirandom sequences", 2018), dealt out along the Z-order, so that whatever a filter averages is nearly even (Ahmed
// and Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels", 2020). Each coordinate
// in [0, 1).
struct SpreadPoint {
  float a, b, c;
};
class SpreadPoints {
 public:
  explicit SpreadPoints(std::uint32_t seed) {
    PixelRandom random(seed, 0);
    for (std::uint32_t& shift : shift_) shift = static_cast<std::uint32_t>(random.uniform() * 0x1p32f);
  }
  SpreadPoint at(std::uint32_t k) const {
    const auto unit = [](std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
    return {unit(shift_[0] + k * 3518319155u), unit(shift_[1] + k * 2882110345u), unit(shift_[2] + k * 2360945575u)};
  }

 private:
  std::uint32_t shift_[3];
};

}  // namespace waretwin
