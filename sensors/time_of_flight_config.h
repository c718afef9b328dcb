// The time-of-flight depth camera of the Azure Kinect as configuration (data: docs/sensors.md; the Orbbec Femto Bolt carries the same
// module).
#pragma once

#include <string>
#include <vector>

#include "core/fields.h"
#include "sensors/lens.h"

namespace waretwin {

// Every effect can be switched off alone. Signals are relative: 1 comes from a white diffuse surface seen straight on from 1 m in the
// narrow modes.
struct TimeOfFlightConfig {
  int width = 640, height = 576;  // pixels
  double focal_px = 490.0;
  // Shaped like factory calibrations of this lens: it bends 37.5 deg to 318 px and 60 deg to 489 px.
  Distortion lens = {.k1 = 6.03, .k2 = 3.75, .k3 = 0.19, .k4 = 6.36, .k5 = 5.79, .k6 = 1.05};
  double offset_right_m = -0.032;  // of the depth lens from the colour lens, along the colour camera's x axis

  double illumination = 1.0;      // how much light the mode throws per direction; wide fields and fewer binned pixels have less
  double background = 0.02;       // signal of sun and lamps, which adds noise only
  double noise_m = 0.00088;       // standard deviation at signal 1 without background, in metres of range
  double wiggle_rms_m = 0.004;    // systematic error over the range, root mean square
  double exposure_s = 0.0128;     // from the first to the last of nine pulses; the frame's stamp is the middle
  double modulation_mhz = 200.0;  // of the light: what differs by half a wave cancels

  double min_signal = 0.009;    // below this a pixel is invalid ("too low")
  double max_signal = 4.5;      // above it, too ("saturated")
  double min_coherence = 0.95;  // a pixel whose looks add up to less than this share of their lengths lies on a depth edge
  double max_indirect = 0.5;    // more light than this by way of others, over what came straight back: "multipath"
  double outlier_m = 0.05;      // a pixel with fewer than two of eight neighbours this near (and 2 % of the range) is an outlier

  bool lens_distortion = true;
  bool motion = true;        // pulses see the camera where it is at their time
  bool mixed_pixels = true;  // pixels have an area; at edges both surfaces answer
  bool multipath = true;     // one bounce
  bool wiggle = true;
  bool noise = true;
  bool invalidation = true;  // low signal, saturation, multipath and outliers; field and range always end the image

  void visit(Fields& f);

  // Declared standard deviation of a range (metres) from the signal: noise_m * sqrt(signal + background) / signal. Photons counted in
  // four shifted windows give a phase whose variance is (signal + background) / signal^2 (R. Lange, "3D time-of-flight distance
  // measurement with custom solid-state image sensors", 2000, section 4.2.2).
  double range_deviation(double signal) const;
};

// The nine pulses, as shares of the exposure from its middle: -1/2 ... 1/2.
constexpr int kTimeOfFlightPulses = 9;
constexpr double pulse_time(int pulse) { return static_cast<double>(pulse) / (kTimeOfFlightPulses - 1) - 0.5; }

}  // namespace waretwin
