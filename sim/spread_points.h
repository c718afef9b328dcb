// Random numbers for neighbouring pixels that a filter averages.
#pragma once

#include <cstdint>

#include "sim/pixel_random.h"

namespace waretwin {

// Points whose every coordinate is spread evenly over [0, 1) among the neighbours of any pixel, so that what a filter averages has little
// noise: each grows from column to column and from row to row by irrational steps (a rank-1 lattice over the picture; the first one's are
// those of M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
struct SpreadPoint {
  float a, b, c;
};
class SpreadPoints {
 public:
  explicit SpreadPoints(std::uint32_t seed) {
    PixelRandom random(seed, 0);
    for (std::uint32_t& shift : shift_) shift = static_cast<std::uint32_t>(random.uniform() * 0x1p32f);
  }
  SpreadPoint at(int column, int row) const {
    // Steps as shares of 2^32, at which the coordinates wrap around.
    const auto unit = [i = static_cast<std::uint32_t>(column), j = static_cast<std::uint32_t>(row)](
                          std::uint32_t shift, std::uint32_t across, std::uint32_t down) {
      return static_cast<float>((shift + i * across + j * down) >> 8) * 0x1p-24f;
    };
    return {unit(shift_[0], 3242174889u, 2447445414u), unit(shift_[1], 1640531527u, 3144134278u),
            unit(shift_[2], 1052792407u, 3668340012u)};
  }

 private:
  std::uint32_t shift_[3];
};

}  // namespace waretwin
