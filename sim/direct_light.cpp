#include "sim/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waretwin {

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

DirectLight::DirectLight(const std::vector<Light>& lights) : lights_(lights) {
  for (const Light& light : lights) {
    const bool directional = light.kind == Light::Kind::kDirectional, spot = light.kind == Light::Kind::kSpot;
    const Eigen::Vector3f p = directional ? Eigen::Vector3f(-light.direction) : light.position;
    x_.push_back(p.x());
    y_.push_back(p.y());
    z_.push_back(p.z());
    w_.push_back(directional ? 0.0f : 1.0f);
    radius2_.push_back(directional ? 0.0f : light.radius * light.radius);
    inverse_range2_.push_back(!directional && std::isfinite(light.range) ? 1.0f / (light.range * light.range) : 0.0f);
    dx_.push_back(light.direction.x());
    dy_.push_back(light.direction.y());
    dz_.push_back(light.direction.z());
    // Clamped to [0, 1] and squared this is the cone's falloff; without a cone it is 1.
    const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
    const float scale = spot ? 1.0f / std::max(inner - outer, 1e-4f) : 0.0f;
    cone_scale_.push_back(scale);
    cone_offset_.push_back(spot ? -outer * scale : 1.0f);
    luminance_.push_back(luminance(light.intensity));
  }
}

Eigen::Vector3f DirectLight::unshadowed(const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v,
                                        LightParts& parts) const {
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  const std::size_t count = lights_.size();
  parts.diffuse.resize(count);
  parts.specular.resize(count);
  parts.weight.resize(count);
  const float px = point.position.x(), py = point.position.y(), pz = point.position.z();
  const float nx = point.normal.x(), ny = point.normal.y(), nz = point.normal.z();
  const float fx = point.face_normal.x(), fy = point.face_normal.y(), fz = point.face_normal.z();
  const float vx = v.x(), vy = v.y(), vz = v.z();
  const float alpha2 = reflection.roughness * reflection.roughness * reflection.roughness * reflection.roughness;
  const float lobe_scale = alpha2 * kInversePi / (4.0f * (reflection.roughness + 0.5f));
  const float diffuse_luminance = luminance(reflection.diffuse), specular_luminance = luminance(reflection.specular);
  const float *lx = x_.data(), *ly = y_.data(), *lz = z_.data(), *lw = w_.data(), *r2 = radius2_.data(), *range2 = inverse_range2_.data();
  const float *ax = dx_.data(), *ay = dy_.data(), *az = dz_.data(), *cone_scale = cone_scale_.data(), *cone_offset = cone_offset_.data();
  const float* bright = luminance_.data();
  float* __restrict diffuse = parts.diffuse.data();
  float* __restrict specular = parts.specular.data();
  float* __restrict weight = parts.weight.data();
  // Plain arithmetic without branches, so that the compiler takes several lights at once.
  for (std::size_t i = 0; i < count; ++i) {
    const float tx = lx[i] - lw[i] * px, ty = ly[i] - lw[i] * py, tz = lz[i] - lw[i] * pz;
    const float d2 = std::max(tx * tx + ty * ty + tz * tz, 1e-8f);
    const float inverse = 1.0f / std::sqrt(d2);
    const float ux = tx * inverse, uy = ty * inverse, uz = tz * inverse;
    const float facing = fx * ux + fy * uy + fz * uz;
    const float cosine = facing > 0.0f ? std::max(nx * ux + ny * uy + nz * uz, 0.0f) : 0.0f;
    const float ratio = d2 * range2[i];
    const float window = std::max(1.0f - ratio * ratio, 0.0f);
    const float cone = std::min(std::max(cone_offset[i] - cone_scale[i] * (ux * ax[i] + uy * ay[i] + uz * az[i]), 0.0f), 1.0f);
    const float e = cosine / std::max(d2, r2[i]) * window * cone * cone;
    const float hx = ux + vx, hy = uy + vy, hz = uz + vz;
    const float inverse_h = 1.0f / std::sqrt(std::max(hx * hx + hy * hy + hz * hz, 1e-12f));
    const float n_dot_h = std::max((nx * hx + ny * hy + nz * hz) * inverse_h, 0.0f);
    const float l_dot_h = std::max((ux * hx + uy * hy + uz * hz) * inverse_h, 0.05f);
    const float d = n_dot_h * n_dot_h * (alpha2 - 1.0f) + 1.0f;
    diffuse[i] = e * kInversePi;
    specular[i] = e * lobe_scale / (d * d * l_dot_h * l_dot_h);
    weight[i] = bright[i] * (diffuse[i] * diffuse_luminance + specular[i] * specular_luminance);
  }
  parts.total = 0.0f;
  Eigen::Vector3f diffuse_sum = Eigen::Vector3f::Zero(), specular_sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    parts.total += weight[i];
    diffuse_sum += diffuse[i] * lights_[i].intensity;
    specular_sum += specular[i] * lights_[i].intensity;
  }
  return reflection.diffuse.cwiseProduct(diffuse_sum) + reflection.specular.cwiseProduct(specular_sum);
}

Eigen::Vector3f DirectLight::radiance(int light, const Reflection& reflection, const LightParts& parts) const {
  const auto i = static_cast<std::size_t>(light);
  return lights_[i].intensity.cwiseProduct(reflection.diffuse * parts.diffuse[i] + reflection.specular * parts.specular[i]);
}

int DirectLight::choose(const LightParts& parts, float pick) {
  if (!(parts.total > 0.0f)) return -1;
  float left = pick * parts.total;
  int last = -1;
  for (std::size_t i = 0; i < parts.weight.size(); ++i) {
    if (!(parts.weight[i] > 0.0f)) continue;
    last = static_cast<int>(i);
    left -= parts.weight[i];
    if (left < 0.0f) break;
  }
  return last;
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
