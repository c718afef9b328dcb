// Unidirectional path tracing with next-event estimation (Kajiya, "The rendering equation", SIGGRAPH 1986).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/direct_light.h"
#include "sim/pixel_random.h"
#include "sim/ray_caster.h"
#include "sim/surfaces.h"

namespace waretwin {

class PathTracer {
 public:
  // Light may reflect `bounces` times after the first surface. All arguments outlive the tracer.
  PathTracer(const RayCaster& ray_caster, const Surfaces& surfaces, const DirectLight& lights, int bounces)
      : ray_caster_(ray_caster), surfaces_(surfaces), lights_(lights), bounces_(bounces) {}

  // One sample of the radiance that arrives along a ray. A ray that leaves the scene at once sees the background, later the ambient light.
  // Energy is kept: a white surface returns what it receives.
  Eigen::Vector3f radiance(const Ray& ray, float spread, PixelRandom& random, std::vector<LitBy>& parts) const;

 private:
  const RayCaster& ray_caster_;
  const Surfaces& surfaces_;
  const DirectLight& lights_;
  int bounces_;
};

}  // namespace waretwin
