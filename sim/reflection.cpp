#include "sim/reflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waretwin {

namespace {

// 2^x by the bits of the exponent and a cubic in between (relative error < 2e-4), for the fit below, whose own error is larger.
float power_of_two(float x) {
  x = std::max(x, -100.0f);
  const float whole = std::floor(x);
  const float f = x - whole;
  const float mantissa = 1.0f + f * (0.6951786f + f * (0.2276491f + f * 0.0771723f));
  return std::ldexp(mantissa, static_cast<int>(whole));
}

}  // namespace

float luminance(const Eigen::Vector3f& rgb) { return 0.2126f * rgb.x() + 0.7152f * rgb.y() + 0.0722f * rgb.z(); }

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

Eigen::Vector3f reflected(const Reflection& r, const Eigen::Vector3f& normal, const Eigen::Vector3f& l, const Eigen::Vector3f& v) {
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  const Eigen::Vector3f sum = l + v;
  const float squared = sum.squaredNorm();
  Eigen::Vector3f out = r.diffuse * kInversePi;
  if (squared < 1e-12f) return out;
  const float inverse = 1.0f / std::sqrt(squared);
  const float n_dot_h = normal.dot(sum) * inverse;
  if (n_dot_h <= 0.0f) return out;
  const float l_dot_h = std::max(l.dot(sum) * inverse, 0.05f);
  const float alpha2 = r.roughness * r.roughness * r.roughness * r.roughness;
  const float d = n_dot_h * n_dot_h * (alpha2 - 1.0f) + 1.0f;
  // D * V * F with V * F approximated by specular / (4 (l.h)^2 (roughness + 0.5)).
  const float lobe = alpha2 * kInversePi / (d * d * 4.0f * l_dot_h * l_dot_h * (r.roughness + 0.5f));
  return out + r.specular * lobe;
}

}  // namespace waretwin
