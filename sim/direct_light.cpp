#include "sim/direct_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

namespace waretwin {

namespace {

// Four lights at once, by the compilers' vector extension (GCC and Clang): plain IEEE arithmetic, lane by lane.
using Four = float __attribute__((vector_size(16)));
constexpr std::size_t kLanes = 4;

Four all(float value) { return Four{value, value, value, value}; }
Four load(const float* from) {
  Four out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
void store(const Four& value, float* to) { std::memcpy(to, &value, sizeof value); }
Four larger(const Four& a, const Four& b) { return a > b ? a : b; }
Four smaller(const Four& a, const Four& b) { return a < b ? a : b; }
Four root(const Four& x) { return Four{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])}; }

}  // namespace

Eigen::Vector2f circle(float turn) {
  constexpr std::size_t kSteps = 1024;
  static const auto table = [] {
    std::array<Eigen::Vector2f, kSteps> points;
    for (std::size_t i = 0; i < kSteps; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kSteps;
      points[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
    return points;
  }();
  return table[static_cast<std::size_t>(turn * static_cast<float>(kSteps)) % kSteps];
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
  // The last group is filled up with dark lights.
  const std::size_t padded = (lights.size() + kLanes - 1) / kLanes * kLanes;
  for (auto* values : {&x_, &y_, &z_, &w_, &radius2_, &inverse_range2_, &dx_, &dy_, &dz_, &cone_scale_, &cone_offset_, &luminance_}) {
    values->resize(padded, 0.0f);
  }
}

void DirectLight::irradiate(const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v, LightParts& parts) const {
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  const std::size_t count = x_.size();
  parts.diffuse.resize(count);
  parts.specular.resize(count);
  parts.weight.resize(count);
  const Eigen::Vector3f &p = point.position, &n = point.normal, &f = point.face_normal;
  const float alpha2 = reflection.roughness * reflection.roughness * reflection.roughness * reflection.roughness;
  const float lobe_scale = alpha2 * kInversePi / (4.0f * (reflection.roughness + 0.5f));
  const float diffuse_luminance = luminance(reflection.diffuse), specular_luminance = luminance(reflection.specular);
  Four total = all(0.0f);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Four w = load(&w_[i]);
    const Four tx = load(&x_[i]) - w * p.x(), ty = load(&y_[i]) - w * p.y(), tz = load(&z_[i]) - w * p.z();
    const Four d2 = larger(tx * tx + ty * ty + tz * tz, all(1e-8f));
    const Four inverse = 1.0f / root(d2);
    const Four ux = tx * inverse, uy = ty * inverse, uz = tz * inverse;
    const Four facing = f.x() * ux + f.y() * uy + f.z() * uz;
    const Four lambert = larger(n.x() * ux + n.y() * uy + n.z() * uz, all(0.0f));
    const Four cosine = facing > 0.0f ? lambert : all(0.0f);
    const Four ratio = d2 * load(&inverse_range2_[i]);
    const Four window = larger(1.0f - ratio * ratio, all(0.0f));
    const Four slant = ux * load(&dx_[i]) + uy * load(&dy_[i]) + uz * load(&dz_[i]);
    const Four cone = smaller(larger(load(&cone_offset_[i]) - load(&cone_scale_[i]) * slant, all(0.0f)), all(1.0f));
    const Four e = cosine / larger(d2, load(&radius2_[i])) * window * cone * cone;
    const Four hx = ux + v.x(), hy = uy + v.y(), hz = uz + v.z();
    const Four inverse_h = 1.0f / root(larger(hx * hx + hy * hy + hz * hz, all(1e-12f)));
    const Four n_dot_h = larger((n.x() * hx + n.y() * hy + n.z() * hz) * inverse_h, all(0.0f));
    const Four l_dot_h = larger((ux * hx + uy * hy + uz * hz) * inverse_h, all(0.05f));
    const Four d = n_dot_h * n_dot_h * (alpha2 - 1.0f) + 1.0f;
    const Four diffuse = e * kInversePi;
    const Four specular = e * lobe_scale / (d * d * l_dot_h * l_dot_h);
    const Four weight = load(&luminance_[i]) * (diffuse * diffuse_luminance + specular * specular_luminance);
    store(diffuse, &parts.diffuse[i]);
    store(specular, &parts.specular[i]);
    store(weight, &parts.weight[i]);
    total += weight;
  }
  parts.total = (total[0] + total[1]) + (total[2] + total[3]);
  parts.diffuse_sum.setZero();
  parts.specular_sum.setZero();
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    if (parts.weight[i] == 0.0f) continue;
    parts.diffuse_sum += parts.diffuse[i] * lights_[i].intensity;
    parts.specular_sum += parts.specular[i] * lights_[i].intensity;
  }
}

Eigen::Vector3f DirectLight::radiance(int light, const Reflection& reflection, const LightParts& parts) const {
  const auto i = static_cast<std::size_t>(light);
  return lights_[i].intensity.cwiseProduct(reflection.diffuse * parts.diffuse[i] + reflection.specular * parts.specular[i]);
}

}  // namespace waretwin
