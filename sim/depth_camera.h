// Depth as a camera of any model delivers it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/camera_config.h"
#include "sim/ray_caster.h"
#include "sim/surfaces.h"

namespace waretwin {

struct DepthReading {
  cv::Mat registered;  // RgbdFrame::depth
  cv::Mat native;      // RgbdFrame::native_depth
};

class DepthCamera {
 public:
  virtual ~DepthCamera() = default;

  // `ideal`: true depth in the colour view (FrameImages::depth). X_WC: the colour camera in the world at any time.
  virtual DepthReading read(const cv::Mat& ideal, Stamp stamp, const std::function<Pose(Stamp)>& X_WC) = 0;

  // The one that camera.depth_model names; `sensor` is the camera's name. `surfaces` outlives it.
  static std::unique_ptr<DepthCamera> make(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor,
                                           std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces);
};

}  // namespace waretwin
