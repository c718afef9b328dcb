// A picture's light before shadows and ambient occlusion are smoothed, kept apart until then. Row-major, one value a pixel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/guided_filter.h"

namespace waretwin {

struct LitPicture {
  int width = 0, height = 0;
  // Radiance, linear RGB; the fourth number means nothing. Four floats are written and read at once.
  std::vector<Eigen::Vector4f> direct;   // from all lights, were nothing in between
  std::vector<Eigen::Vector4f> ambient;  // from all around, were nothing near
  std::vector<std::uint8_t> glows;       // 1: the pixel has a value in `emitted`, which few have
  std::vector<Eigen::Vector3f> emitted;
  std::vector<float> visible;  // share of the lights that is; kUnknown where no ray was cast
  SurfaceGuide guide;

  // The same surfaces at every other pixel of every other row, from which occlusion is looked for.
  SurfaceGuide half_guide;
  std::vector<Eigen::Vector3f> half_positions, half_normals;
  std::vector<float> half_times;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  std::size_t half_index(int x, int y) const {
    return static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(half_guide.width) + static_cast<std::size_t>(x / 2);
  }

  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    direct.resize(pixels);
    ambient.resize(pixels);
    glows.resize(pixels);
    emitted.resize(pixels);
    visible.resize(pixels);
    guide.resize(width, height);
    half_guide.resize((width + 1) / 2, (height + 1) / 2);
    half_positions.resize(half_guide.depth.size());
    half_normals.resize(half_guide.depth.size());
    half_times.resize(half_guide.depth.size());
  }
};

}  // namespace waretwin
