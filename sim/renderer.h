// Pictures of a hall.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/intrinsics.h"
#include "sim/frame_images.h"
#include "sim/pixel_rays.h"
#include "sim/ray_caster.h"
#include "sim/render_options.h"
#include "sim/surfaces.h"

namespace waretwin {

struct RenderRequest {
  bool colour = true;
  bool radiance = false;  // the light itself, for a camera model
  bool classes = false;
  bool normals = false;
  // Key of the random numbers; see RandomStream.
  std::uint64_t seed = 1;
  std::string sensor = "camera";
  Stamp stamp = 0;
};

// Keeps buffers from one picture to the next: one Renderer renders one picture at a time (on all threads).
class Renderer {
 public:
  Renderer(std::shared_ptr<const RayCaster> ray_caster, const RenderOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // At request.stamp, within the ray caster's shutter. The same bytes for the same arguments, whatever was rendered before and at any
  // thread count.
  FrameImages render(const Intrinsics& intrinsics, const Pose& X_WC, const RenderRequest& request);
  // Along any rays. Quality path looks during the whole exposure, fast in its middle, as geometry does in both.
  FrameImages render(const PixelRays& pixel_rays, const RenderRequest& request);

  // The hall's surfaces, for sensors that look with other light; as long as the renderer lives.
  const Surfaces& surfaces() const;
  const RayCaster& ray_caster() const;
  const RenderOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin
