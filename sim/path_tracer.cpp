#include "sim/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace waretwin {

namespace {

constexpr float kWideSpread = 0.1f;  // radians
constexpr int kSureBounces = 1;      // however dim the path

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

void PathTracer::trace(std::span<LightPath> paths) {
  live_.resize(paths.size());
  std::iota(live_.begin(), live_.end(), std::size_t{0});
  for (int depth = 0; !live_.empty(); ++depth) {
    const Coherence coherence = depth == 0 ? Coherence::kCoherent : Coherence::kIncoherent;
    rays_.clear();
    for (const std::size_t index : live_) rays_.push_back(paths[index].ray);
    hits_.resize(rays_.size());
    ray_caster_.cast(rays_, hits_, coherence);
    going_on_.clear();
    for (std::size_t i = 0; i < live_.size(); ++i) {
      if (meet(paths, live_[i], hits_[i], depth)) going_on_.push_back(live_[i]);
    }
    add_unshadowed(paths, coherence);
    live_.swap(going_on_);
  }
}

// What a path's ray hit; whether the path goes on from there.
bool PathTracer::meet(std::span<LightPath> paths, std::size_t index, const Hit& hit, int depth) {
  const Scene& scene = ray_caster_.scene();
  LightPath& path = paths[index];
  if (!hit.valid()) {
    path.radiance += path.throughput.cwiseProduct(depth == 0 ? scene.background : scene.ambient);
    return false;
  }
  // After a bounce a path stands for a wide cone, so coarse textures will do.
  const SurfacePoint point = surfaces_.at(path.ray, hit, depth == 0 ? spread_ : kWideSpread);
  const Eigen::Vector3f v = -path.ray.direction.normalized();
  const Reflection reflection = reflection_of(point, std::max(point.normal.dot(v), 1e-3f));
  path.radiance += path.throughput.cwiseProduct(point.emissive);
  look_for_light(path, index, point, reflection, v);
  return depth < bounces_ && scatter(path, point, reflection, v, depth);
}

// Towards one of the lights, chosen by what it sends.
void PathTracer::look_for_light(LightPath& path, std::size_t index, const SurfacePoint& point, const Reflection& reflection,
                                const Eigen::Vector3f& v) {
  lights_.irradiate(point, reflection, v, parts_);
  const float pick = path.random.uniform(), s = path.random.uniform(), t = path.random.uniform();
  const int light = DirectLight::choose(parts_, pick);
  if (light < 0) return;
  const float chance = parts_.weight[static_cast<std::size_t>(light)] / parts_.total;
  shadows_.push_back({index, path.throughput.cwiseProduct(lights_.radiance(light, reflection, parts_)) / chance});
  shadow_rays_.push_back(lights_.shadow_ray(light, lifted(point), s, t));
  shadow_rays_.back().time = path.ray.time;
}

void PathTracer::add_unshadowed(std::span<LightPath> paths, Coherence coherence) {
  blocked_.resize(shadow_rays_.size());
  ray_caster_.occluded(shadow_rays_, blocked_, coherence);
  for (std::size_t i = 0; i < shadows_.size(); ++i) {
    if (!blocked_[i]) paths[shadows_[i].path].radiance += shadows_[i].light;
  }
  shadows_.clear();
  shadow_rays_.clear();
}

// The path's next piece, unless it ends here.
bool PathTracer::scatter(LightPath& path, const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v,
                         int depth) const {
  // One of the two layers goes on, chosen by how much each reflects; each lobe carries its layer's whole albedo.
  const float glossy = luminance(reflection.glossy_albedo), diffuse = luminance(reflection.diffuse);
  if (!(glossy + diffuse > 0.0f)) return false;
  const float chance = glossy / (glossy + diffuse);
  const float layer = path.random.uniform(), r1 = path.random.uniform(), r2 = path.random.uniform();
  Eigen::Vector3f direction;
  if (layer < chance) {
    direction = glossy_direction(point.normal, v, reflection.roughness, r1, r2);
    path.throughput = path.throughput.cwiseProduct(reflection.glossy_albedo) / chance;
  } else {
    direction = cosine_direction(point.normal, r1, r2);
    path.throughput = path.throughput.cwiseProduct(reflection.diffuse) / (1.0f - chance);
  }
  // Below the face: turned up again, so that no energy is lost at bent normals and rough edges.
  const float below = direction.dot(point.face_normal);
  if (below <= 0.0f) direction -= (2.0f * below - 1e-4f) * point.face_normal;
  direction.normalize();

  // Russian roulette for dim paths.
  const float bright = path.throughput.maxCoeff();
  if (depth >= kSureBounces && bright < 0.5f) {
    const float survive = std::max(bright * 2.0f, 0.05f);
    if (path.random.uniform() >= survive) return false;
    path.throughput /= survive;
  }
  Ray next;
  next.origin = lifted(point);
  next.direction = direction;
  next.time = path.ray.time;
  path.ray = next;
  return true;
}

}  // namespace waretwin
