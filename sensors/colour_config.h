// The colour camera of the Azure Kinect as configuration (data: docs/sensors.md).
#pragma once

#include "core/fields.h"
#include "sensors/lens.h"

namespace waretwin {

// Every effect can be switched off alone; without any, pictures are those of an ideal pinhole camera. Radiance is relative: 1 is white.
struct ColourConfig {
  // Shaped like factory calibrations of this lens, whose numerator and denominator nearly cancel: corners move outwards by 6 %.
  Distortion lens = {.k1 = 0.50, .k2 = -2.55, .k3 = 1.47, .k4 = 0.38, .k5 = -2.36, .k6 = 1.38, .p1 = 4e-4, .p2 = -3e-4};
  bool rectify = true;      // the driver undistorts the picture to the pinhole view
  double readout_s = 0.02;  // rolling shutter: from the first row's exposure to the last one's; the stamp is the middle row's middle
  double exposure_s = 0.008;

  double sensitivity_e_per_s = 250000.0;  // photo-electrons a second at radiance 1; pictures don't get darker with a shorter exposure
  double full_well_e = 24000.0;           // no pixel holds more
  double read_noise_e = 4.0;              // standard deviation
  double vignetting_strength = 0.3;       // share of the natural falloff, cos^4 of the angle, that is left; see falloff
  double white_balance_error = 0.04;      // red and blue are off by at most this share

  bool lens_distortion = true;
  bool rolling_shutter = true;  // rows see the camera where it is at their time
  bool motion_blur = true;      // each pixel sees its light over the exposure
  bool noise = true;            // shot and read noise, full well
  bool vignetting = true;
  bool white_balance = true;

  void visit(Fields& f);

  bool is_ideal() const;
  void set_ideal();  // switches all effects off

  double electrons_at_white() const { return sensitivity_e_per_s * exposure_s; }
  // Declared variance of a value (linear radiance) in a place that receives `radiance`: photons arrive by themselves, the amplifier adds
  // its own.
  double variance(double radiance) const;
  // Share of the light that arrives from a direction (x, y, 1), r2 = x^2 + y^2: 1 - vignetting_strength * (1 - cos^4).
  double falloff(double r2) const;
};

}  // namespace waretwin
