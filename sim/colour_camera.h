// Colour pictures as a camera delivers them: taken row by row through its lens, while it moves, by a noisy sensor, then undistorted.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/camera_config.h"
#include "sensors/colour_model.h"
#include "sensors/rectification.h"
#include "sim/frame_images.h"
#include "sim/object_views.h"
#include "sim/pixel_rays.h"
#include "sim/renderer.h"

namespace waretwin {

class ColourCamera {
 public:
  // `sensor` is the camera's name; seed and sensor key the random numbers. `renderer` outlives the camera. Throws Error for a lens that
  // does not cover the view.
  ColourCamera(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor, Renderer& renderer);

  // No ray of a picture travels earlier or later than this before and after its stamp: what the ray caster's shutter must cover.
  Stamp half_span() const;

  // One picture. X_WC: the camera in the world at any time. All images have the camera's size and are in CameraConfig::view.
  // - colour, instances and, when asked for, classes agree to the pixel: each row's moment and the lens are in them, and where the picture
  //   is undistorted, a label is that of the sensor pixel nearest to the place. A blurred edge's label is that of the middle of its
  //   exposure. Noise has no part in labels.
  // - depth is what an ideal depth camera sees at the stamp, all rows at once. Where that is not along the colour's rays, it is looked at
  //   apart: it agrees with the colours of a camera that stands still, and else with RgbdFrame::depth.
  // - normals are not made.
  // Rays travel at their own times (Ray::time) within the ray caster's shutter; in quality fast, blur is that of the camera's motion alone.
  // Without any effect the colours are those of Renderer::render. Without `depth`, which costs a look of its own, there is none.
  FrameImages look(Stamp stamp, const std::function<Pose(Stamp)>& X_WC, bool colour, bool classes = false, bool depth = true);

  // The rays that gave the pixels of look's instance image their ids, in CameraConfig::view; beyond the picture those of a pinhole camera
  // at the stamp. Valid as long as this camera and while the shutter is the same.
  PictureRays picture_rays(Stamp stamp, const std::function<Pose(Stamp)>& X_WC) const;

  // When row v of the sensor is in the middle of its exposure, from the stamp. 0 for all without a rolling shutter.
  Stamp row_delay(int v) const;

 private:
  std::vector<PixelRays::Row> rows(Stamp stamp, const std::function<Pose(Stamp)>& X_WC) const;

  CameraConfig camera_;
  std::uint64_t seed_;
  std::string sensor_;
  Renderer& renderer_;
  Lens lens_;
  bool bent_;                                   // the lens distorts
  std::optional<ColourModel> model_;            // none without any effect
  std::optional<Rectification> rectification_;  // none where the sensor's picture is delivered
};

}  // namespace waretwin
