// One picture of a hall from any pose.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "core/pose.h"
#include "sensors/intrinsics.h"
#include "sim/ray_caster.h"
#include "sim/render_options.h"

namespace waretwin {

struct StillPicture {
  cv::Mat colour;     // CV_8UC3, BGR
  cv::Mat depth;      // CV_32FC1, metres along the optical axis, ideal, 0 = no surface
  cv::Mat instances;  // CV_16UC1, TrueObject::id, 0 = background
};

// Renders the hall as it stands in the middle of the caster's shutter and as a pinhole camera at X_WC sees it. The options' exposure
// applies as it is (a scenario's own is the caller's to multiply in).
StillPicture render_still(std::shared_ptr<const RayCaster> ray_caster, const Intrinsics& intrinsics, const Pose& X_WC,
                          const RenderOptions& options, std::uint64_t seed = 1);

}  // namespace waretwin
