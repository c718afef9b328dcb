#include "sim/still.h"

#include "sim/renderer.h"

namespace waretwin {

StillPicture render_still(std::shared_ptr<const RayCaster> ray_caster, const Intrinsics& intrinsics, const Pose& X_WC,
                          const RenderOptions& options, std::uint64_t seed) {
  Renderer renderer(std::move(ray_caster), options);
  RenderRequest request;
  request.seed = seed;
  request.sensor = "still";
  FrameImages images = renderer.render(intrinsics, X_WC, request);
  return {std::move(images.colour), std::move(images.depth), std::move(images.instances)};
}

}  // namespace waretwin
