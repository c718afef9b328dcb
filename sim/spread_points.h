// Random numbers for neighbouring pixels that a filter averages.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "sim/pixel_random.h"

namespace waretwin {

// A point for each second pixel, every coordinate in [0, 1) and spread evenly among the neighbours of any pixel, so that what a filter
// averages has little noise. Each pixel of a tile has another point, and tiles repeat (interleaved sampling, Keller and Heidrich 2001):
// a filter as wide as a tile sees every point once, wherever it stands, and leaves no pattern on what looks the same all over.
struct SpreadPoint {
  float a, b, c;
};
class SpreadPoints {
 public:
  static constexpr int kTile = 8;  // pixels a side

  explicit SpreadPoints(std::uint32_t seed) {
    PixelRandom random(seed, 0);
    for (std::uint32_t& shift : shift_) shift = static_cast<std::uint32_t>(random.uniform() * 0x1p32f);
  }
  // Of the pixels that look: half of them, as on a chessboard; a filter fills the rest.
  static bool looks_from(int x, int y) { return ((x ^ y) & 1) == 0; }

  // The point of such a pixel.
  SpreadPoint at(int x, int y) const {
    static const Tile tile = make_tile();
    const std::array<std::uint32_t, 3>& point = tile[place(x, y)];
    return {unit(shift_[0] + point[0]), unit(shift_[1] + point[1]), unit(shift_[2] + point[2])};
  }

 private:
  // Numbers are shares of 2^32, at which they wrap around.
  static constexpr int kPoints = kTile * kTile / 2;
  using Tile = std::array<std::array<std::uint32_t, 3>, kPoints>;

  static float unit(std::uint32_t share) { return static_cast<float>(share >> 8) * 0x1p-24f; }
  static std::size_t place(int x, int y) { return static_cast<std::size_t>((y & (kTile - 1)) * (kTile / 2) + ((x & (kTile - 1)) >> 1)); }

  // Each coordinate takes the values 0, 1/32, 2/32 ... once, in the order of a rank-1 lattice over the tile, so that a part of a tile
  // has evenly spread ones, too: at an edge a filter sees no more. The first coordinate's steps are those of M. Roberts, "The
  // unreasonable effectiveness of quasirandom sequences", 2018.
  static Tile make_tile() {
    constexpr std::uint32_t kAcross[] = {3242174889u, 1640531527u, 1052792407u}, kDown[] = {2447445414u, 3144134278u, 3668340012u};
    Tile tile{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::uint32_t, kPoints> value{};
      for (int y = 0; y < kTile; ++y) {
        for (int x = y & 1; x < kTile; x += 2) {
          value[place(x, y)] = static_cast<std::uint32_t>((x + y) >> 1) * kAcross[k] + static_cast<std::uint32_t>((x - y) >> 1) * kDown[k];
        }
      }
      std::array<std::size_t, kPoints> order{};
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::sort(order.begin(), order.end(), [&value](std::size_t i, std::size_t j) { return value[i] < value[j]; });
      for (std::size_t i = 0; i < order.size(); ++i) tile[order[i]][k] = static_cast<std::uint32_t>((std::uint64_t{i} << 32) / kPoints);
    }
    return tile;
  }

  std::array<std::uint32_t, 3> shift_;
};

}  // namespace waretwin
