#include "sensors/time_of_flight_config.h"

#include <cmath>

namespace waretwin {

void TimeOfFlightConfig::visit(Fields& f) {
  f("width", width, "pixels of the depth image", {.min = 16, .max = 4096});
  f("height", height, "pixels of the depth image", {.min = 16, .max = 4096});
  f("focal_px", focal_px, "focal length in pixels", {.min = 1, .max = 10000});
  f.group("lens", lens, "distortion of the depth lens");
  f("offset_right_m", offset_right_m, "depth lens from colour lens, along the colour camera's x axis", {.min = -1, .max = 1});
  f("illumination", illumination, "light of the mode per direction", {.min = 0.001, .max = 1000});
  f("background", background, "signal of foreign light, which adds noise", {.min = 0, .max = 1000});
  f("noise_m", noise_m, "standard deviation of the range at signal 1 without foreign light", {.min = 0, .max = 1});
  f("wiggle_rms_m", wiggle_rms_m, "systematic error over the range, root mean square", {.min = 0, .max = 0.1});
  f("exposure_s", exposure_s, "from the first to the last of nine pulses", {.min = 0, .max = 1});
  f("modulation_mhz", modulation_mhz, "modulation of the light", {.min = 1, .max = 1000});
  f("min_signal", min_signal, "pixels with less are invalid", {.min = 0, .max = 1000});
  f("max_signal", max_signal, "pixels with more are invalid", {.min = 0, .max = 1e6});
  f("min_coherence", min_coherence, "pixels whose parts agree less are invalid (depth edges)", {.min = 0, .max = 1});
  f("max_indirect", max_indirect, "pixels with more multipath, over direct light, are invalid", {.min = 0, .max = 1000});
  f("outlier_m", outlier_m, "pixels farther than this (and 2 % of the range) from all but one neighbour are invalid",
    {.min = 0, .max = 10});
  f("lens_distortion", lens_distortion, "false: a pinhole lens on whose image the same field fits");
  f("motion", motion, "false: all pulses at the frame's stamp");
  f("mixed_pixels", mixed_pixels, "false: a pixel sees its centre only");
  f("multipath", multipath, "false: no light by way of another surface");
  f("wiggle", wiggle, "false: no systematic error");
  f("noise", noise, "false: no random error");
  f("invalidation", invalidation, "false: every pixel in field and range is valid");
}

double TimeOfFlightConfig::range_deviation(double signal) const { return noise_m * std::sqrt(signal + background) / signal; }

}  // namespace waretwin
