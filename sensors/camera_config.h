// Colour and depth cameras as configuration, with the presets that stand for products.
#pragma once

#include <string>

#include "core/fields.h"
#include "sensors/intrinsics.h"
#include "sensors/mount.h"

namespace waretwin {

// The part of the colour image in which the camera has depth. Azure Kinect: the depth camera's hexagonal field of interest, 75 x 65 deg,
// tilted 6 deg down from the colour camera (shared data sheet values; NFOV).
struct DepthField {
  double horizontal_deg = 75.0;
  double vertical_deg = 65.0;
  double tilt_down_deg = 6.0;
  bool hexagonal = true;  // corners cut as by the illumination mask; false: the full rectangle
  void visit(Fields& f);
};

// First-order error of a depth reading: Gaussian with standard deviation base + growth * z^2, independent from pixel to pixel.
struct DepthNoise {
  bool enabled = true;
  // Azure Kinect: about 1 mm at 1 m and 5 mm at 3 m on bright diffuse targets; the maker promises <= 17 mm.
  double sigma_base_m = 0.0005;
  double sigma_per_m2 = 0.0005;  // metres per square metre of depth
  double dropout_share = 0.01;   // share of pixels that read nothing
  void visit(Fields& f);
};

// The defaults are those of preset azure_kinect, mounted as in the paper's section 4.3: on the vehicle's centre, 1.4 m high, 45 deg down.
struct CameraConfig {
  std::string preset = "azure_kinect";
  int width = 1280, height = 720;  // pixels
  double horizontal_fov_deg = 90.0, vertical_fov_deg = 59.0;
  double rate_hz = 15.0;
  double depth_min_m = 0.5, depth_max_m = 3.86;
  DepthField field;
  DepthNoise noise;
  Mount mount = {.z_m = 1.4, .pitch_deg = 45.0};

  // Presets: azure_kinect (NFOV unbinned), ideal (same geometry without field mask and noise). Throws Error naming the known ones.
  static CameraConfig make(const std::string& preset);
  Intrinsics intrinsics() const;
  // A `preset` that changes sets all other fields but the mount, before those that follow it.
  void visit(Fields& f);
};

}  // namespace waretwin
