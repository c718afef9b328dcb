// Pictures are made in tiles of 16 x 8 pixels, whose rays travel in packets of 4 x 2.
#pragma once

#include <array>
#include <cstddef>

#include "sim/ray_caster.h"

namespace waretwin {

struct PixelTile {
  static constexpr int kWidth = 16, kHeight = 8, kPixels = kWidth * kHeight;
  static constexpr int kPacketWidth = 4, kPacketHeight = 2;

  struct Offset {
    int x, y;
  };
  // Pixel of the i-th ray: packet by packet, in each the 2 x 2 quads one after the other, in each row by row.
  static const std::array<Offset, kPixels> kOrder;

  int left = 0, top = 0;  // multiples of the tile's size; pixels beyond the picture's border are there, too
  std::array<Ray, kPixels> rays;
  std::array<Hit, kPixels> hits;
};

namespace detail {
constexpr std::array<PixelTile::Offset, PixelTile::kPixels> make_tile_order() {
  std::array<PixelTile::Offset, PixelTile::kPixels> order{};
  std::size_t i = 0;
  for (int py = 0; py < PixelTile::kHeight; py += PixelTile::kPacketHeight) {
    for (int px = 0; px < PixelTile::kWidth; px += PixelTile::kPacketWidth) {
      for (int qx = 0; qx < PixelTile::kPacketWidth; qx += 2) {
        for (int k = 0; k < 4; ++k) order[i++] = {px + qx + (k & 1), py + (k >> 1)};
      }
    }
  }
  return order;
}
}  // namespace detail

inline constexpr std::array<PixelTile::Offset, PixelTile::kPixels> PixelTile::kOrder = detail::make_tile_order();

}  // namespace waretwin
