#include "sensors/stereo_config.h"

#include <algorithm>
#include <cmath>

namespace waretwin {

void StereoConfig::visit(Fields& f) {
  f("width", width, "pixels of the depth image", {.min = 16, .max = 4096});
  f("height", height, "pixels of the depth image", {.min = 16, .max = 4096});
  f("focal_px", focal_px, "focal length of both cameras in pixels", {.min = 1, .max = 10000});
  f("baseline_m", baseline_m, "from the left camera to the right one", {.min = 0.001, .max = 2});
  f("offset_right_m", offset_right_m, "left camera from colour lens, along the colour camera's x axis", {.min = -1, .max = 1});
  f("max_disparity_px", max_disparity_px, "disparities that are searched", {.min = 1, .max = 4096});
  f("disparity_shift_px", disparity_shift_px, "smallest disparity that is searched", {.min = 0, .max = 4096});
  f("window_px", window_px, "side of the square that is matched; odd", {.min = 1, .max = 63});
  if (window_px % 2 == 0) f.reject("window_px", "must be odd");
  f("steps_per_px", steps_per_px, "disparities are whole multiples of one over this", {.min = 1, .max = 1024});
  f("subpixel_px", subpixel_px, "standard deviation of a disparity on a well textured surface", {.min = 0, .max = 10});
  f("calibration_px", calibration_px, "bound of a disparity error that stays for the run", {.min = 0, .max = 10});
  f("projector_power", projector_power, "brightness of the dots on a white surface at 1 m", {.min = 0, .max = 1000});
  f("dot_share", dot_share, "share of the picture that dots cover", {.min = 0, .max = 1});
  f("ambient", ambient, "brightness of a white floor by the hall's light", {.min = 0, .max = 1000});
  f("image_noise", image_noise, "noise of a pixel over the root of its brightness", {.min = 0, .max = 10});
  f("min_texture", min_texture, "windows with less contrast over noise have no match", {.min = 0, .max = 1000});
  f("saturation", saturation, "pixels brighter than this times 0.1 + ambient have no match", {.min = 0, .max = 1e6});
  f("projector", projector, "false: no dots, passive stereo");
  f("occlusion", occlusion, "false: the right camera sees everything");
  f("fattening", fattening, "false: depth edges stay where they are");
  f("texture", texture, "false: every surface is well textured");
  f("noise", noise, "false: no random error");
  f("correlation", correlation, "false: the random error of a pixel is its own");
  f("calibration", calibration, "false: no error that stays for the run");
  f("quantisation", quantisation, "false: disparities of any value");
}

double StereoConfig::texture_of(double ambient_deviation, double ambient_mean, double dots_mean) const {
  const double square = ambient_deviation * ambient_deviation + dot_share * (1.0 - dot_share) * dots_mean * dots_mean;
  const double deviation = image_noise * std::sqrt((0.1 + ambient) * (0.1 + ambient_mean + dot_share * dots_mean));
  // A camera without noise sees any contrast.
  return std::sqrt(square) / std::max(deviation, 1e-12);
}

double StereoConfig::disparity_deviation(double contrast) const {
  if (!texture) return subpixel_px;
  return std::sqrt(subpixel_px * subpixel_px + 2.0 / (window_px * window_px * contrast * contrast));
}

double StereoConfig::depth_deviation(double depth, double contrast) const {
  return depth * depth / depth_times_disparity() * disparity_deviation(contrast);
}

}  // namespace waretwin
