#include "sim/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waretwin {

namespace {

// Smooth end of a light's range as KHR_lights_punctual recommends: 1 - (d / range)^4, not below 0.
float window(float squared, float range) {
  if (!std::isfinite(range)) return 1.0f;
  const float ratio = squared / (range * range);
  return std::max(0.0f, 1.0f - ratio * ratio);
}

float cone(const Light& light, const Eigen::Vector3f& l) {
  const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
  const float x = std::clamp((-l.dot(light.direction) - outer) / std::max(inner - outer, 1e-4f), 0.0f, 1.0f);
  return x * x;
}

}  // namespace

Eigen::Vector3f lifted(const SurfacePoint& point) {
  const float size = point.position.cwiseAbs().maxCoeff();
  return point.position + (2e-4f + 4e-6f * size) * point.face_normal;
}

void make_basis(const Eigen::Vector3f& n, Eigen::Vector3f& a, Eigen::Vector3f& b) {
  const float sign = std::copysign(1.0f, n.z());
  const float p = -1.0f / (sign + n.z());
  const float q = n.x() * n.y() * p;
  a = {1.0f + sign * n.x() * n.x() * p, sign * q, -sign * n.x()};
  b = {q, sign + n.y() * n.y() * p, -n.y()};
}

Eigen::Vector3f DirectLight::irradiance(int index, const SurfacePoint& point, Eigen::Vector3f& l) const {
  const Light& light = lights_[static_cast<std::size_t>(index)];
  if (light.kind == Light::Kind::kDirectional) {
    l = -light.direction;
    const float cosine = point.normal.dot(l);
    if (cosine <= 0.0f || point.face_normal.dot(l) <= 0.0f) return Eigen::Vector3f::Zero();
    return cosine * light.intensity;
  }
  const Eigen::Vector3f to_light = light.position - point.position;
  const float cosine_d = point.normal.dot(to_light);
  if (cosine_d <= 0.0f || point.face_normal.dot(to_light) <= 0.0f) return Eigen::Vector3f::Zero();
  // Nearer than its own radius an emitter no longer looks like a point.
  const float squared = std::max(to_light.squaredNorm(), 1e-8f);
  const float distance = std::sqrt(squared);
  l = to_light / distance;
  float factor = cosine_d / (distance * std::max(squared, light.radius * light.radius)) * window(squared, light.range);
  if (light.kind == Light::Kind::kSpot) factor *= cone(light, l);
  return factor * light.intensity;
}

Eigen::Vector3f DirectLight::unshadowed(const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v,
                                        std::vector<LitBy>& parts) const {
  parts.clear();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f l = Eigen::Vector3f::Zero();
  for (int i = 0; i < static_cast<int>(lights_.size()); ++i) {
    const Eigen::Vector3f e = irradiance(i, point, l);
    if (e.isZero(0.0f)) continue;
    const Eigen::Vector3f radiance = e.cwiseProduct(reflected(reflection, point.normal, l, v));
    sum += radiance;
    parts.push_back({i, radiance});
  }
  return sum;
}

int DirectLight::choose(const std::vector<LitBy>& parts, float pick, float& total) {
  total = 0.0f;
  for (const LitBy& part : parts) total += luminance(part.radiance);
  if (!(total > 0.0f)) return -1;
  float left = pick * total;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    left -= luminance(parts[i].radiance);
    if (left < 0.0f) return static_cast<int>(i);
  }
  return static_cast<int>(parts.size()) - 1;
}

Ray DirectLight::shadow_ray(int index, const SurfacePoint& point, float s, float t) const {
  const Light& light = lights_[static_cast<std::size_t>(index)];
  Ray ray;
  ray.origin = lifted(point);
  if (light.kind == Light::Kind::kDirectional) {
    ray.direction = -light.direction;
    return ray;
  }
  ray.direction = light.position - ray.origin;
  ray.far = 0.9999f;
  const float length = ray.direction.norm();
  if (light.radius <= 0.0f || length <= light.radius) return ray;
  Eigen::Vector3f a, b;
  make_basis(ray.direction / length, a, b);
  const float radius = light.radius * std::sqrt(s), angle = 2.0f * std::numbers::pi_v<float> * t;
  ray.direction += radius * (std::cos(angle) * a + std::sin(angle) * b);
  return ray;
}

}  // namespace waretwin
