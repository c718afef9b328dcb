// Smoothing of noisy shadow and occlusion terms within surfaces, never across their edges.
#pragma once

#include <cstdint>
#include <vector>

namespace waretwin {

// What tells one surface from the next, row-major, one value a pixel.
struct SurfaceGuide {
  int width = 0, height = 0;
  std::vector<float> depth;           // metres; 0 = no surface
  std::vector<float> tolerance;       // metres: how much depth may change from one pixel to the next on the pixel's own surface
  std::vector<std::uint32_t> normal;  // packed_normal()

  void resize(int new_width, int new_height);
};

std::uint32_t packed_normal(float x, float y, float z);  // components in [-1, 1], 8 bits each

// Whether pixels p and q, `steps` apart, lie on one smooth surface.
bool same_surface(const SurfaceGuide& guide, std::size_t p, std::size_t q, int steps);

// A value that is still to be filled in.
inline constexpr float kUnknown = -1.0f;

// Mean over the known among 2 radius + 1 neighbours on the same surface, along rows first, then along columns. The outermost count half, so
// that values known at every other pixel have the same weight wherever the window lies. 1 where no neighbour on any
// surface is known to be below 1, and where none is known after both passes.
// Values are >= 0 or kUnknown. `scratch` is kept by the caller.
void smooth(const SurfaceGuide& guide, int radius, std::vector<float>& values, std::vector<float>& scratch);

// Values of a half-size image (pixel (x, y) belongs to full-size pixel (2x, 2y)) at full-size pixel (x, y): bilinear among the neighbours
// on the same surface, `otherwise` the nearest.
float upsampled(const SurfaceGuide& full, const SurfaceGuide& half, const std::vector<float>& half_values, int x, int y);

}  // namespace waretwin
