#include "sensors/camera_config.h"

#include "core/error.h"

namespace waretwin {

void DepthField::visit(Fields& f) {
  f("horizontal_deg", horizontal_deg, "width of the depth field", {.min = 1, .max = 179});
  f("vertical_deg", vertical_deg, "height of the depth field", {.min = 1, .max = 179});
  f("tilt_down_deg", tilt_down_deg, "how far the depth camera looks below the colour camera", {.min = -90, .max = 90});
  f("hexagonal", hexagonal, "cut the corners as the illumination mask does");
}

void DepthNoise::visit(Fields& f) {
  f("enabled", enabled, "false switches the depth error off");
  f("sigma_base_m", sigma_base_m, "standard deviation at zero distance", {.min = 0, .max = 1});
  f("sigma_per_m2", sigma_per_m2, "its growth with the square of the depth", {.min = 0, .max = 1});
  f("dropout_share", dropout_share, "share of pixels without a reading", {.min = 0, .max = 1});
}

CameraConfig CameraConfig::make(const std::string& preset) {
  CameraConfig camera;
  camera.preset = preset;
  if (preset == "azure_kinect") return camera;
  if (preset == "ideal") {
    camera.field = {.horizontal_deg = 179.0, .vertical_deg = 179.0, .tilt_down_deg = 0.0, .hexagonal = false};
    camera.noise.enabled = false;
    camera.depth_min_m = 0.05;
    camera.depth_max_m = 20.0;
    return camera;
  }
  throw Error("camera preset '" + preset + "' is not known; expected azure_kinect or ideal");
}

Intrinsics CameraConfig::intrinsics() const {
  return Intrinsics::from_field_of_view(width, height, to_radians(horizontal_fov_deg), to_radians(vertical_fov_deg));
}

void CameraConfig::visit(Fields& f) {
  const std::string before = preset;
  f("preset", preset, "the product whose values the other keys start from", {.choices = {"azure_kinect", "ideal"}});
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
  f("depth_min_m", depth_min_m, "no depth nearer than this", {.min = 0.001, .max = 100});
  f("depth_max_m", depth_max_m, "no depth beyond this", {.min = 0.001, .max = 65.535});
  if (depth_max_m <= depth_min_m) f.reject("depth_max_m", "must be greater than depth_min_m");
  f.group("field", field, "where in the colour image there is depth");
  f.group("noise", noise, "error of the depth reading");
  f.group("mount", mount, "place on the vehicle");
}

}  // namespace waretwin
