#include "sensors/camera_config.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace waretwin {

void DepthField::visit(Fields& f) {
  f("horizontal_deg", horizontal_deg, "width of the depth field", {.min = 1, .max = 179});
  f("vertical_deg", vertical_deg, "height of the depth field", {.min = 1, .max = 179});
  f("tilt_down_deg", tilt_down_deg, "how far the depth camera looks below the colour camera", {.min = -90, .max = 90});
  f("shape", shape, "outline of the depth field", {.choices = {"hexagon", "circle", "rectangle"}});
}

void DepthNoise::visit(Fields& f) {
  f("enabled", enabled, "false switches the depth error off");
  f("sigma_base_m", sigma_base_m, "standard deviation at zero distance", {.min = 0, .max = 1});
  f("sigma_per_m2", sigma_per_m2, "its growth with the square of the depth", {.min = 0, .max = 1});
  f("dropout_share", dropout_share, "share of pixels without a reading", {.min = 0, .max = 1});
}

namespace {

const std::vector<std::string>& presets() {
  static const std::vector<std::string> names = {"azure_kinect", "femto_bolt", "azure_kinect_gaussian", "realsense_d435", "ideal"};
  return names;
}

struct DepthMode {
  const char* name;
  int width, height;
  double focal_px;
  double horizontal_deg, vertical_deg;
  const char* shape;
  double nearest_m, farthest_m, exposure_s;
};

// Data sheet. The chip has 1024 x 1024 pixels; NFOV reads its middle, 2x2 binning halves the resolution.
const std::vector<DepthMode>& depth_modes() {
  static const std::vector<DepthMode> modes = {
      {"nfov_unbinned", 640, 576, 490.0, 75.0, 65.0, "hexagon", 0.50, 3.86, 0.0128},
      {"nfov_2x2binned", 320, 288, 245.0, 75.0, 65.0, "hexagon", 0.50, 5.46, 0.0128},
      {"wfov_2x2binned", 512, 512, 245.0, 120.0, 120.0, "circle", 0.25, 2.88, 0.0128},
      {"wfov_unbinned", 1024, 1024, 490.0, 120.0, 120.0, "circle", 0.25, 2.21, 0.0203},
  };
  return modes;
}

std::vector<std::string> depth_mode_names() {
  std::vector<std::string> names;
  for (const DepthMode& mode : depth_modes()) names.emplace_back(mode.name);
  return names;
}

}  // namespace

CameraConfig CameraConfig::make(const std::string& preset) {
  CameraConfig camera;
  camera.preset = preset;
  if (preset == "azure_kinect" || preset == "femto_bolt") return camera;
  if (preset == "realsense_d435") {
    // Data sheet (Intel RealSense D400 series, document 337029): depth 87 x 58 deg, to about 10 m (at its best up to 3 m); colour 69 x 42
    // deg, here 1280 x 720 of its 1920 x 1080 pixels. Depth begins at 0.28 m with 1280 x 720 pixels and in proportion to them with fewer.
    // It takes 6 to 90 frames a second; 15 are what the other cameras do.
    camera.horizontal_fov_deg = 69.4;
    camera.vertical_fov_deg = 42.5;
    camera.depth_model = "stereo";
    camera.depth_min_m = 0.19;
    camera.depth_max_m = 10.0;
    camera.field = {.horizontal_deg = 87.0, .vertical_deg = 58.0, .tilt_down_deg = 0.0, .shape = "rectangle"};
    // Its colour pictures leave the device undistorted.
    camera.colour.lens_distortion = false;
    return camera;
  }
  camera.depth_model = "gaussian";
  camera.colour.set_ideal();
  if (preset == "azure_kinect_gaussian") return camera;
  if (preset == "ideal") {
    camera.field = {.horizontal_deg = 179.0, .vertical_deg = 179.0, .tilt_down_deg = 0.0, .shape = "rectangle"};
    camera.noise.enabled = false;
    camera.depth_min_m = 0.05;
    camera.depth_max_m = 20.0;
    return camera;
  }
  throw Error("camera preset '" + preset +
              "' is not known; expected azure_kinect, femto_bolt, azure_kinect_gaussian, realsense_d435 or ideal");
}

void CameraConfig::set_depth_mode(const std::string& name) {
  for (const DepthMode& mode : depth_modes()) {
    if (mode.name != name) continue;
    depth_mode = name;
    time_of_flight.width = mode.width;
    time_of_flight.height = mode.height;
    time_of_flight.focal_px = mode.focal_px;
    time_of_flight.exposure_s = mode.exposure_s;
    // A mode's range ends where dark surfaces (15 %) give just enough light: the light of the others follows from theirs.
    const double narrow_m = depth_modes().front().farthest_m;
    time_of_flight.illumination = mode.farthest_m * mode.farthest_m / (narrow_m * narrow_m);
    field.horizontal_deg = mode.horizontal_deg;
    field.vertical_deg = mode.vertical_deg;
    field.shape = mode.shape;
    depth_min_m = mode.nearest_m;
    depth_max_m = mode.farthest_m;
    return;
  }
  throw Error("depth mode '" + name + "' is not known; expected nfov_unbinned, nfov_2x2binned, wfov_2x2binned or wfov_unbinned");
}

Intrinsics CameraConfig::intrinsics() const {
  return Intrinsics::from_field_of_view(width, height, to_radians(horizontal_fov_deg), to_radians(vertical_fov_deg));
}

Lens CameraConfig::colour_lens() const {
  const Intrinsics pinhole = intrinsics();
  if (!colour.lens_distortion || colour.lens.is_none()) return Lens(pinhole);
  const Lens bent(pinhole, colour.lens);
  double reach = 0.0;  // of the view's border, over the image's
  const auto reach_out = [&](int u, int v) {
    const auto pixel = bent.project(pinhole.ray(u, v));
    if (!pixel) throw Error("colour.lens folds over within the image; expected a distortion that grows from the middle to the corners");
    reach = std::max({reach, std::abs(pixel->x() - pinhole.cx) / pinhole.cx, std::abs(pixel->y() - pinhole.cy) / pinhole.cy});
  };
  for (int u = 0; u < width; ++u) {
    reach_out(u, 0);
    reach_out(u, height - 1);
  }
  for (int v = 0; v < height; ++v) {
    reach_out(0, v);
    reach_out(width - 1, v);
  }
  return Lens(Intrinsics::checked(width, height, pinhole.fx / reach, pinhole.fy / reach, pinhole.cx, pinhole.cy), colour.lens);
}

Lens CameraConfig::view() const { return colour.rectify ? Lens(intrinsics()) : colour_lens(); }

Lens CameraConfig::depth_lens() const {
  if (depth_model == "stereo") {
    return Lens(Intrinsics::checked(stereo.width, stereo.height, stereo.focal_px, stereo.focal_px, 0.5 * (stereo.width - 1),
                                    0.5 * (stereo.height - 1)));
  }
  const TimeOfFlightConfig& t = time_of_flight;
  double focal = t.focal_px;
  if (!t.lens_distortion) {
    focal = std::min(0.5 * t.width / std::tan(to_radians(0.5 * field.horizontal_deg)),
                     0.5 * t.height / std::tan(to_radians(0.5 * field.vertical_deg)));
  }
  return Lens(Intrinsics::checked(t.width, t.height, focal, focal, 0.5 * (t.width - 1), 0.5 * (t.height - 1)),
              t.lens_distortion ? t.lens : Distortion{});
}

Pose CameraConfig::X_CD() const {
  Pose X = Pose::Identity();
  // Turning about x by a negative angle takes the optical axis towards +y, which points down.
  X.linear() = Eigen::AngleAxisd(-to_radians(field.tilt_down_deg), Eigen::Vector3d::UnitX()).toRotationMatrix();
  X.translation() = Eigen::Vector3d(depth_model == "stereo" ? stereo.offset_right_m : time_of_flight.offset_right_m, 0.0, 0.0);
  return X;
}

void CameraConfig::visit(Fields& f) {
  const std::string before = preset;
  f("preset", preset, "the product whose values the other keys start from", {.choices = presets()});
  if (preset != before) {
    const Mount kept = mount;
    *this = make(preset);
    mount = kept;
  }
  f("width", width, "image width in pixels", {.min = 16, .max = 8192});
  f("height", height, "image height in pixels", {.min = 16, .max = 8192});
  f("horizontal_fov_deg", horizontal_fov_deg, "field of view of the colour camera", {.min = 1, .max = 170});
  f("vertical_fov_deg", vertical_fov_deg, "field of view of the colour camera", {.min = 1, .max = 170});
  f("rate_hz", rate_hz, "frames a second", {.min = 0.01, .max = 1000});
  const std::string mode_before = depth_mode;
  f("depth_mode", depth_mode, "mode of the Azure Kinect: resolution, field, range and light", {.choices = depth_mode_names()});
  if (depth_mode != mode_before) {
    if (depth_model == "stereo") f.reject("depth_mode", "is of the Azure Kinect; " + preset + " has none");
    set_depth_mode(depth_mode);
  }
  f("depth_model", depth_model, "how depth comes about", {.choices = {"time_of_flight", "stereo", "gaussian"}});
  f("depth_min_m", depth_min_m, "no depth nearer than this", {.min = 0.001, .max = 100});
  f("depth_max_m", depth_max_m, "no depth beyond this", {.min = 0.001, .max = 65.535});
  if (depth_max_m <= depth_min_m) f.reject("depth_max_m", "must be greater than depth_min_m");
  f.group("field", field, "directions in which the depth camera measures");
  f.group("time_of_flight", time_of_flight, "depth_model time_of_flight: lens, light and errors");
  f.group("stereo", stereo, "depth_model stereo: cameras, projector and errors");
  f.group("noise", noise, "depth_model gaussian: error of the depth reading");
  f.group("colour", colour, "lens, shutter and errors of the colour pictures");
  f.group("mount", mount, "place on the vehicle");
}

}  // namespace waretwin
