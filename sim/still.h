// One picture of a hall from any pose.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/pose.h"
#include "scenes/scene.h"
#include "sensors/intrinsics.h"
#include "sim/render_options.h"

namespace waretwin {

struct StillPicture {
  cv::Mat colour;     // CV_8UC3, BGR
  cv::Mat depth;      // CV_32FC1, metres along the optical axis, ideal, 0 = no surface
  cv::Mat instances;  // CV_16UC1, TrueObject::id, 0 = background
};

// Renders the scene as a pinhole camera at X_WC sees it. The options' exposure applies as it is (a scenario's own is the caller's to
// multiply in). Throws Error for a scene without triangles or a CPU without the instruction set `isa`.
StillPicture render_still(std::shared_ptr<const Scene> scene, const Intrinsics& intrinsics, const Pose& X_WC, const RenderOptions& options,
                          std::uint64_t seed = 1, const std::string& isa = "avx2");

}  // namespace waretwin
