#include "sensors/colour_config.h"

namespace waretwin {

void ColourConfig::visit(Fields& f) {
  f.group("lens", lens, "distortion of the colour lens");
  f("rectify", rectify, "true: the driver undistorts pictures to the pinhole view");
  f("readout_s", readout_s, "from the exposure of the first row to that of the last", {.min = 0, .max = 0.2});
  f("exposure_s", exposure_s, "of each row", {.min = 1e-6, .max = 0.2});
  f("sensitivity_e_per_s", sensitivity_e_per_s, "photo-electrons a second at radiance 1", {.min = 1, .max = 1e12});
  f("full_well_e", full_well_e, "electrons that a pixel holds", {.min = 1, .max = 1e9});
  f("read_noise_e", read_noise_e, "standard deviation in electrons", {.min = 0, .max = 1e6});
  f("vignetting_strength", vignetting_strength, "share of the falloff with cos^4 that is left", {.min = 0, .max = 1});
  f("white_balance_error", white_balance_error, "largest error of the gains of red and blue", {.min = 0, .max = 0.9});
  f("lens_distortion", lens_distortion, "false: a pinhole lens");
  f("rolling_shutter", rolling_shutter, "false: all rows at the frame's stamp");
  f("motion_blur", motion_blur, "false: no time passes during the exposure");
  f("noise", noise, "false: no shot and read noise, no full well");
  f("vignetting", vignetting, "false: corners as bright as the middle");
  f("white_balance", white_balance, "false: true colours");
}

bool ColourConfig::is_ideal() const {
  return !lens_distortion && !rolling_shutter && !motion_blur && !noise && !vignetting && !white_balance;
}

void ColourConfig::set_ideal() { lens_distortion = rolling_shutter = motion_blur = noise = vignetting = white_balance = false; }

double ColourConfig::variance(double radiance) const {
  const double white = electrons_at_white();
  return (radiance * white + read_noise_e * read_noise_e) / (white * white);
}

double ColourConfig::falloff(double r2) const {
  const double cos2 = 1.0 / (1.0 + r2);
  return 1.0 - vignetting_strength * (1.0 - cos2 * cos2);
}

}  // namespace waretwin
