// Unidirectional path tracing with next-event estimation (Kajiya, "The rendering equation", SIGGRAPH 1986).
#pragma once

#include <Eigen/Core>

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
  // A white dielectric returns all that it receives; rough metal lacks what it would scatter twice.
  Eigen::Vector3f radiance(const Ray& ray, float spread, PixelRandom& random, LightParts& parts) const;

 private:
  const RayCaster& ray_caster_;
  const Surfaces& surfaces_;
  const DirectLight& lights_;
  int bounces_;
};

}  // namespace waretwin
