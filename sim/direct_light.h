// Light that comes straight from a scene's lights.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenes/scene.h"
#include "sim/ray_caster.h"
#include "sim/reflection.h"

namespace waretwin {

// One light as a surface point sees it, were nothing in between.
struct LitBy {
  int light = -1;                                      // index into the scene's lights
  Eigen::Vector3f radiance = Eigen::Vector3f::Zero();  // reflected towards the viewer, linear RGB
};

class DirectLight {
 public:
  explicit DirectLight(const std::vector<Light>& lights) : lights_(lights) {}

  // Irradiance of one light on a surface whose shading normal is given, nothing in between: intensity over squared distance
  // (KHR_lights_punctual, range window included) times the cosine. l becomes the unit direction to the light. Zero where the light is
  // behind the surface.
  Eigen::Vector3f irradiance(int light, const SurfacePoint& point, Eigen::Vector3f& l) const;

  // Sum over all lights of what the point reflects towards v (unit) unshadowed. Writes each contributing light to `parts`
  // (cleared first; kept by the caller to save allocations).
  Eigen::Vector3f unshadowed(const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v,
                             std::vector<LitBy>& parts) const;

  // Picks a part with probability proportional to its luminance; `pick` in [0, 1). `total` is the sum of luminances. -1 where all is dark.
  static int choose(const std::vector<LitBy>& parts, float pick, float& total);

  // From the point to a place on the light's emitter, a disc that faces the point; s and t in [0, 1) choose the place. Directional lights
  // have no size. Any hit on the ray is a shadow.
  Ray shadow_ray(int light, const SurfacePoint& point, float s, float t) const;

 private:
  const std::vector<Light>& lights_;
};

// Where rays that leave a surface start: a little above it, so that they don't meet it again.
Eigen::Vector3f lifted(const SurfacePoint& point);

// Two unit vectors that make a right-handed frame with unit n (Duff et al., "Building an orthonormal basis, revisited", JCGT 2017).
void make_basis(const Eigen::Vector3f& n, Eigen::Vector3f& a, Eigen::Vector3f& b);

}  // namespace waretwin
