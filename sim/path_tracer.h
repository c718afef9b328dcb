// Unidirectional path tracing with next-event estimation (Kajiya, "The rendering equation", SIGGRAPH 1986).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/direct_light.h"
#include "sim/pixel_random.h"
#include "sim/ray_caster.h"
#include "sim/surfaces.h"

namespace waretwin {

// One sample of the radiance that arrives along a ray.
struct LightPath {
  Ray ray;  // at first the one that is asked about, then the path's next piece
  PixelRandom random;
  Eigen::Vector3f radiance = Eigen::Vector3f::Zero();  // linear RGB, what is found
  Eigen::Vector3f throughput = Eigen::Vector3f::Ones();
};

// For one thread.
class PathTracer {
 public:
  // Light may reflect `bounces` times after the first surface. `spread`: angle of a pixel, radians. All objects outlive the tracer.
  PathTracer(const RayCaster& ray_caster, const Surfaces& surfaces, const DirectLight& lights, int bounces, float spread)
      : ray_caster_(ray_caster), surfaces_(surfaces), lights_(lights), bounces_(bounces), spread_(spread) {}

  // Follows all paths, side by side, so that their rays travel in packets; neighbours should lie together. A ray that leaves the scene at
  // once sees the background, later the ambient light. A white dielectric returns all that it receives; rough metal lacks what it would
  // scatter twice.
  void trace(std::span<LightPath> paths);

 private:
  struct Shadow {
    std::size_t path;
    Eigen::Vector3f light;  // arrives if nothing is in between
  };

  bool meet(std::span<LightPath> paths, std::size_t index, const Hit& hit, int depth);
  void look_for_light(LightPath& path, std::size_t index, const SurfacePoint& point, const Reflection& reflection,
                      const Eigen::Vector3f& v);
  bool scatter(LightPath& path, const SurfacePoint& point, const Reflection& reflection, const Eigen::Vector3f& v, int depth) const;
  void add_unshadowed(std::span<LightPath> paths, Coherence coherence);

  const RayCaster& ray_caster_;
  const Surfaces& surfaces_;
  const DirectLight& lights_;
  const int bounces_;
  const float spread_;
  // Kept from call to call.
  LightParts parts_;
  std::vector<std::size_t> live_, going_on_;
  std::vector<Ray> rays_, shadow_rays_;
  std::vector<Hit> hits_;
  std::vector<Shadow> shadows_;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace waretwin
