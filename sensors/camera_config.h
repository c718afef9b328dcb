// Colour and depth cameras as configuration, with the presets that stand for products.
#pragma once

#include <string>

#include "core/fields.h"
#include "core/pose.h"
#include "sensors/colour_config.h"
#include "sensors/intrinsics.h"
#include "sensors/mount.h"
#include "sensors/stereo_config.h"
#include "sensors/time_of_flight_config.h"

namespace waretwin {

// The directions in which a depth camera measures, seen from its own lens, and how far it looks down from the colour camera. Azure Kinect:
// the illuminated field of interest (data sheet; NFOV).
struct DepthField {
  double horizontal_deg = 75.0;
  double vertical_deg = 65.0;
  double tilt_down_deg = 6.0;
  std::string shape = "hexagon";  // hexagon, circle (an ellipse where the angles differ) or rectangle
  void visit(Fields& f);
};

// The simplest error of a depth reading: Gaussian with standard deviation base + growth * z^2, independent from pixel to pixel.
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
  std::string depth_mode = "nfov_unbinned";  // of the Azure Kinect and the Femto Bolt; see set_depth_mode
  // How depth comes about. time_of_flight and stereo: in a lens of its own, then warped into the colour view (`time_of_flight`, `stereo`).
  // gaussian: straight in the colour view (`noise`).
  std::string depth_model = "time_of_flight";
  double depth_min_m = 0.5, depth_max_m = 3.86;
  DepthField field;
  TimeOfFlightConfig time_of_flight;
  StereoConfig stereo;
  DepthNoise noise;
  ColourConfig colour;
  Mount mount = {.z_m = 1.4, .pitch_deg = 45.0};

  // Presets: azure_kinect, femto_bolt (the same depth module), azure_kinect_gaussian (one lens, Gaussian error of depth), ideal (the same
  // colour view, depth everywhere in it, without error; these two see ideal colours), realsense_d435 (stereo). Throws Error naming the
  // known ones.
  static CameraConfig make(const std::string& preset);
  // Resolution, field, range, exposure and light of nfov_unbinned, nfov_2x2binned, wfov_2x2binned or wfov_unbinned (data sheet); throws
  // Error for another.
  void set_depth_mode(const std::string& mode);
  // The pinhole view of the fields of view above: what a rectified picture shows.
  Intrinsics intrinsics() const;
  // Of the colour camera. With distortion, its focal length is the longest at which the image holds the whole pinhole view, which is what
  // the maker's angles mean. Throws Error for a distortion that folds over within the image.
  Lens colour_lens() const;
  // In which RgbdFrame's pictures are delivered: the pinhole view, but colour_lens() where `colour` is not rectified.
  Lens view() const;
  // Of the camera that depth_model names. Time of flight: without distortion, the pinhole lens through which the field just fits into the
  // image. Stereo: the rectified left camera, a pinhole lens.
  Lens depth_lens() const;
  // That camera in the colour camera's frame: beside it, tilted down by field.tilt_down_deg.
  Pose X_CD() const;
  // A `preset` that changes sets all other fields but the mount, and a `depth_mode` what belongs to it, before those that follow it.
  void visit(Fields& f);
};

}  // namespace waretwin
