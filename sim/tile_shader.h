// Light on what the rays of a tile hit, one look a pixel (quality fast).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/direct_light.h"
#include "sim/lit_picture.h"
#include "sim/pixel_tile.h"
#include "sim/ray_caster.h"
#include "sim/spread_points.h"
#include "sim/surfaces.h"

namespace waretwin {

// For one thread; several write to the same picture, each its own tiles.
class TileShader {
 public:
  // Without `shadows` every light is seen. `spread`: angle of a pixel, radians. `seed`: of the rays towards the lights.
  TileShader(const RayCaster& ray_caster, const Surfaces& surfaces, const DirectLight& lights, bool shadows, float spread,
             std::uint32_t seed, LitPicture& picture);

  void shade(const PixelTile& tile);

 private:
  // How one smooth surface looks from here, for neighbouring pixels.
  struct Look {
    SurfacePoint point;
    Reflection reflection;
    Eigen::Vector3f v;  // to the viewer, unit
    float n_dot_v = 0.0f, cosine = 0.0f, depth = 0.0f;
    std::uint32_t normal = 0;  // of the face, packed
  };
  struct Shadow {
    int light;
    std::size_t pixel;
    Ray ray;
  };

  Look look(const Ray& ray, const Hit& hit) const;
  bool on_one_face(const PixelTile& tile, std::size_t first, std::size_t count) const;
  void shade_face(const PixelTile& tile, std::size_t first, std::size_t count);
  void shade_apart(const PixelTile& tile, std::size_t first);
  void write_background(int x, int y);
  void write_surface(int x, int y, const Hit& hit, const Look& look, const Eigen::Vector3f& position, float time);
  void look_for_light(int x, int y, const Look& look, const Eigen::Vector3f& position, float time);
  void cast_shadows();

  const RayCaster& ray_caster_;
  const Surfaces& surfaces_;
  const DirectLight& lights_;
  bool shadows_;
  float spread_;
  SpreadPoints points_;
  LitPicture& picture_;
  LightParts parts_;                 // of the last look
  std::vector<std::uint8_t> place_;  // of each light's rays among all
  std::array<Shadow, PixelTile::kPixels> rays_;
  std::size_t ray_count_ = 0;
};

}  // namespace waretwin
