#include "sim/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waretwin {

namespace {

Eigen::Vector3f cosine_direction(const Eigen::Vector3f& n, float s, float t) {
  Eigen::Vector3f a, b;
  make_basis(n, a, b);
  const float radius = std::sqrt(s), angle = 2.0f * std::numbers::pi_v<float> * t;
  return radius * std::cos(angle) * a + radius * std::sin(angle) * b + std::sqrt(std::max(0.0f, 1.0f - s)) * n;
}

// Mirrors v at a microfacet normal drawn from GGX's distribution (Walter et al., EGSR 2007, equations 35 and 36).
Eigen::Vector3f glossy_direction(const Eigen::Vector3f& n, const Eigen::Vector3f& v, float roughness, float s, float t) {
  Eigen::Vector3f a, b;
  make_basis(n, a, b);
  const float alpha = roughness * roughness;
  const float cos2 = (1.0f - s) / (1.0f + (alpha * alpha - 1.0f) * s);
  const float cosine = std::sqrt(cos2), sine = std::sqrt(std::max(0.0f, 1.0f - cos2)), angle = 2.0f * std::numbers::pi_v<float> * t;
  const Eigen::Vector3f h = sine * std::cos(angle) * a + sine * std::sin(angle) * b + cosine * n;
  return 2.0f * v.dot(h) * h - v;
}

}  // namespace

Eigen::Vector3f PathTracer::radiance(const Ray& first, float spread, PixelRandom& random, LightParts& parts) const {
  const Scene& scene = ray_caster_.scene();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero(), throughput = Eigen::Vector3f::Ones();
  Ray ray = first;
  for (int depth = 0;; ++depth) {
    const Hit hit = ray_caster_.cast(ray);
    if (!hit.valid()) return sum + throughput.cwiseProduct(depth == 0 ? scene.background : scene.ambient);
    // After a bounce a path stands for a wide cone, so coarse textures will do.
    const SurfacePoint point = surfaces_.at(ray, hit, depth == 0 ? spread : 0.1f);
    const Eigen::Vector3f v = -ray.direction.normalized();
    const float n_dot_v = std::max(point.normal.dot(v), 1e-3f);
    const Reflection reflection = reflection_of(point, n_dot_v);
    sum += throughput.cwiseProduct(point.emissive);

    lights_.irradiate(point, reflection, v, parts);
    const float pick = random.uniform(), s = random.uniform(), t = random.uniform();
    const int light = DirectLight::choose(parts, pick);
    Ray shadow;
    if (light >= 0) {
      shadow = lights_.shadow_ray(light, lifted(point), s, t);
      shadow.time = first.time;
    }
    if (light >= 0 && !ray_caster_.occluded(shadow)) {
      const float chance = parts.weight[static_cast<std::size_t>(light)] / parts.total;
      sum += throughput.cwiseProduct(lights_.radiance(light, reflection, parts)) / chance;
    }
    if (depth == bounces_) return sum;

    // One of the two layers goes on, chosen by how much each reflects; each lobe carries its layer's whole albedo.
    const float glossy = luminance(reflection.glossy_albedo), diffuse = luminance(reflection.diffuse);
    if (!(glossy + diffuse > 0.0f)) return sum;
    const float chance = glossy / (glossy + diffuse);
    const float layer = random.uniform(), r1 = random.uniform(), r2 = random.uniform();
    Eigen::Vector3f direction;
    if (layer < chance) {
      direction = glossy_direction(point.normal, v, reflection.roughness, r1, r2);
      throughput = throughput.cwiseProduct(reflection.glossy_albedo) / chance;
    } else {
      direction = cosine_direction(point.normal, r1, r2);
      throughput = throughput.cwiseProduct(reflection.diffuse) / (1.0f - chance);
    }
    // Below the face: turned up again, so that no energy is lost at bent normals and rough edges.
    const float below = direction.dot(point.face_normal);
    if (below <= 0.0f) direction -= (2.0f * below - 1e-4f) * point.face_normal;
    direction.normalize();

    // Russian roulette for dim paths.
    const float bright = throughput.maxCoeff();
    if (depth >= 2 && bright < 0.5f) {
      const float survive = std::max(bright * 2.0f, 0.05f);
      if (random.uniform() >= survive) return sum;
      throughput /= survive;
    }
    ray = {};
    ray.origin = lifted(point);
    ray.direction = direction;
    ray.time = first.time;
  }
}

}  // namespace waretwin
