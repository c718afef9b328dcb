#include "sim/reflection.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace waretwin {

namespace {

// 2^x by the bits of the exponent and a cubic in between (relative error < 2e-4), for the fit below, whose own error is larger.
float power_of_two(float x) {
  x = std::max(x, -100.0f);
  const int whole = static_cast<int>(x) - 1;  // x <= 0
  const float f = x - static_cast<float>(whole);
  const float mantissa = 1.0f + f * (0.6951786f + f * (0.2276491f + f * 0.0771723f));
  return mantissa * std::bit_cast<float>((whole + 127) << 23);
}

}  // namespace

Reflection reflection_of(const SurfacePoint& point, float n_dot_v) {
  Reflection r;
  const float metallic = std::clamp(point.metallic, 0.0f, 1.0f);
  r.roughness = std::clamp(point.roughness, 0.045f, 1.0f);
  r.specular = Eigen::Vector3f::Constant(0.04f * (1.0f - metallic)) + metallic * point.base_colour;
  const float x = 1.0f - r.roughness, y = 0.0425f - 0.0275f * r.roughness, z = 1.04f - 0.572f * r.roughness,
              w = 0.022f * r.roughness - 0.04f;
  const float a004 = std::min(x * x, power_of_two(-9.28f * n_dot_v)) * x + y;
  const float scale = -1.04f * a004 + z, bias = 1.04f * a004 + w;
  r.glossy_albedo = (r.specular * scale + Eigen::Vector3f::Constant(bias)).cwiseMax(0.0f).cwiseMin(1.0f);
  r.diffuse = (1.0f - metallic) * point.base_colour.cwiseProduct(Eigen::Vector3f::Ones() - r.glossy_albedo);
  return r;
}

}  // namespace waretwin
