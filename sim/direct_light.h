// Light that comes straight from a scene's lights.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "scenes/scene.h"
#include "sim/ray_caster.h"
#include "sim/reflection.h"

namespace waretwin {

// What the lights send towards one viewer of one surface point, were nothing in between. Lists are by light, then some dark ones; kept by
// the caller to save allocations.
struct LightParts {
  std::vector<float> diffuse;   // irradiance / pi, for a light of unit intensity
  std::vector<float> specular;  // irradiance times the glossy lobe without its reflectance, likewise
  std::vector<float> weight;    // luminance of what is reflected
  float total = 0.0f;           // sum of weights
  Eigen::Vector3f diffuse_sum = Eigen::Vector3f::Zero(), specular_sum = Eigen::Vector3f::Zero();  // over all lights with their intensities

  // Radiance of all lights together.
  Eigen::Vector3f reflected_by(const Reflection& reflection) const {
    return reflection.diffuse.cwiseProduct(diffuse_sum) + reflection.specular.cwiseProduct(specular_sum);
  }
};

class DirectLight {
 public:
  explicit DirectLight(const std::vector<Light>& lights);
  std::size_t count() const { return lights_.size(); }

  // All lights on a point that is seen from direction v (unit), unshadowed: intensity over squared distance with the range window and
  // cones of KHR_lights_punctual, times the cosine, times glTF's reflection (diffuse / pi + D V F, V F approximated as in Karis,
  // "Physically based shading on mobile"). Nearer than its own radius a light no longer gains.
  void irradiate(const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v, LightParts& parts) const;
  // One light's share of that sum.
  Eigen::Vector3f radiance(int light, const Reflection& reflection, const LightParts& parts) const;

  // Picks a light with probability weight / total; `pick` in [0, 1). -1 where all is dark.
  static int choose(const LightParts& parts, float pick);

  // From a place, lifted() off its surface, to one on the light's emitter, a disc that faces it; s and t in [0, 1) choose where.
  // Directional lights have no size. Any hit on the ray is a shadow.
  Ray shadow_ray(int light, const Eigen::Vector3f& origin, float s, float t) const;

 private:
  const std::vector<Light>& lights_;
  // The lights again, one array a value, for the loop that runs for every pixel. A directional light is the point (-direction, w = 0).
  std::vector<float> x_, y_, z_, w_, radius2_, inverse_range2_, dx_, dy_, dz_, cone_scale_, cone_offset_, luminance_;
};

// Where rays that leave a surface start: a little above it, so that they don't meet it again.
inline Eigen::Vector3f lifted(const Eigen::Vector3f& position, const Eigen::Vector3f& face_normal) {
  const float size = position.cwiseAbs().maxCoeff();
  return position + (2e-4f + 4e-6f * size) * face_normal;
}
inline Eigen::Vector3f lifted(const SurfacePoint& point) { return lifted(point.position, point.face_normal); }

// Cosine and sine of a turn in [0, 1), in steps of 1/1024.
Eigen::Vector2f circle(float turn);

// Two unit vectors that make a right-handed frame with unit n (Duff et al., "Building an orthonormal basis, revisited", JCGT 2017).
inline void make_basis(const Eigen::Vector3f& n, Eigen::Vector3f& a, Eigen::Vector3f& b) {
  const float sign = std::copysign(1.0f, n.z());
  const float p = -1.0f / (sign + n.z());
  const float q = n.x() * n.y() * p;
  a = {1.0f + sign * n.x() * n.x() * p, sign * q, -sign * n.x()};
  b = {q, sign + n.y() * n.y() * p, -n.y()};
}

// Inline: a ray that a call returns is copied from where it was just written, float by float, in larger pieces, which wait for the memory.
inline Ray DirectLight::shadow_ray(int index, const Eigen::Vector3f& origin, float s, float t) const {
  const Light& light = lights_[static_cast<std::size_t>(index)];
  Ray ray;
  ray.origin = origin;
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
  const float radius = light.radius * std::sqrt(s);
  const Eigen::Vector2f around = circle(t);
  ray.direction += radius * (around.x() * a + around.y() * b);
  return ray;
}

inline int DirectLight::choose(const LightParts& parts, float pick) {
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

}  // namespace waretwin
