#include "sim/still.h"

#include "sim/ray_caster.h"
#include "sim/renderer.h"

namespace waretwin {

StillPicture render_still(std::shared_ptr<const Scene> scene, const Intrinsics& intrinsics, const Pose& X_WC, const RenderOptions& options,
                          std::uint64_t seed, const std::string& isa) {
  RayCasterOptions caster_options;
  caster_options.isa = isa;
  Renderer renderer(std::make_shared<RayCaster>(std::move(scene), caster_options), options);
  RenderRequest request;
  request.seed = seed;
  request.sensor = "still";
  FrameImages images = renderer.render(intrinsics, X_WC, request);
  return {std::move(images.colour), std::move(images.depth), std::move(images.instances)};
}

}  // namespace waretwin
