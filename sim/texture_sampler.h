// Looking up textures: wrap modes, bilinear filtering, the sRGB curve, and smaller copies against aliasing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace waretwin {

// IEC 61966-2-1: a stored 8-bit value as linear light in [0, 1]; srgb_from_linear (sensors/tone_curve.h) takes it back.
float linear_from_srgb(std::uint8_t value);

// Alpha in [0, 1] at full size; uv after the texture transform.
float sample_alpha(const Texture& texture, const Eigen::Vector2f& uv);

// A texture with its pyramid of half-size copies. Keeps a reference to nothing.
class TextureSampler {
 public:
  // How the stored numbers are read: colours through the sRGB curve, anything else (normals, roughness) as value / 255.
  enum class Encoding { kSrgb, kLinear };
  TextureSampler(const Texture& texture, Encoding encoding);

  // Colour at uv (v = 0 is the top row). `footprint` is the width in uv units that one sample stands for; the copy whose texels are
  // about that wide is filtered bilinearly. Linear values, alpha last.
  Eigen::Vector4f sample(const Eigen::Vector2f& uv, float footprint) const { return sample_level(uv, level(footprint)); }
  // The same in two steps. Copies are numbered from the full size, 0.
  int level(float footprint) const;
  Eigen::Vector4f sample_level(const Eigen::Vector2f& uv, int level) const;

 private:
  // Values as they are read, 65535 = 1: no table to look into for each of a sample's sixteen numbers, and steps finer than the stored ones.
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint16_t> rgba;
  };
  static Level half_of(const Level& finer);

  std::vector<Level> levels_;
  Texture::Wrap wrap_u_, wrap_v_;
  bool nearest_;
  float size_;  // geometric mean of width and height in texels
};

}  // namespace waretwin
