// A stereo depth camera with a dot projector as configuration: the Intel RealSense D435 (data: docs/sensors.md).
#pragma once

#include "core/fields.h"

namespace waretwin {

// Two infrared cameras side by side, rectified; depth is in the left one's view. Every effect can be switched off alone. Brightness is
// relative: 1 is what a dot of the projector makes of a white diffuse surface seen straight on from 1 m.
struct StereoConfig {
  // Data sheet (Intel RealSense D400 series, document 337029): the D435's resolution of choice, 90 deg wide after rectification.
  int width = 848, height = 480;   // pixels
  double focal_px = 424.0;         // of both cameras
  double baseline_m = 0.050;       // from the left camera to the right one
  double offset_right_m = -0.015;  // of the left camera from the colour lens, along the colour camera's x axis

  // The matcher of the D4 chip: where it searches, over which square, in which steps. "Tuning depth cameras for best performance" (Intel)
  // names the search (126 pixels), the shift and the subpixel deviation; 9 x 9 is the size of its census transform in the presets.
  double max_disparity_px = 126.0;
  double disparity_shift_px = 0.0;  // where the search begins: brings the nearest and the farthest depth nearer
  int window_px = 9;                // side of the square that is matched; odd
  double steps_per_px = 32.0;       // disparities are whole multiples of 1 / steps
  double subpixel_px = 0.08;        // standard deviation of a disparity on a well textured surface
  double calibration_px = 0.1;      // bound of a disparity error that stays for the run; at 2 m 19 mm, the maker promises 40 mm

  double projector_power = 1.0;  // of the dots
  double dot_share = 0.05;       // of the picture that dots cover: one dot of four pixels in 9 x 9 (about 5000 in the field)
  double ambient = 0.2;          // brightness of a white floor by the lamps of a hall; sunlight is a hundred times as bright
  double image_noise = 0.0055;   // of a pixel; see texture_of
  double min_texture = 1.0;      // windows whose contrast is less than this many deviations of a pixel have no match
  double saturation = 100.0;     // pixels brighter than this times the exposure's light are white in both pictures: no match

  bool projector = true;     // off: passive stereo
  bool occlusion = true;     // what the right camera does not see has no match
  bool fattening = true;     // foregrounds grow by half a window
  bool texture = true;       // false: every surface is well textured
  bool noise = true;         // the random part of a disparity
  bool correlation = true;   // false: the random part is independent from pixel to pixel
  bool calibration = true;   // the part that stays for the run
  bool quantisation = true;  // steps of disparity; depth is in whole millimetres in any case

  void visit(Fields& f);

  // Metres times pixels: depth is this over disparity.
  double depth_times_disparity() const { return focal_px * baseline_m; }
  // Contrast of a window over the deviation of its pixels. `ambient_deviation`: root mean square of how its pixels differ from the mean of
  // their row, without dots (only what changes along a row helps to match); `ambient_mean`, `dots_mean`: brightness of the surface by
  // the hall's light and of the dots on it. Dots are two levels of brightness that cover dot_share of the window; the noise of a pixel
  // is that of light counted on a floor, in an exposure that ends the sooner the brighter the hall is:
  // image_noise * sqrt((0.1 + ambient) (0.1 + brightness)).
  double texture_of(double ambient_deviation, double ambient_mean, double dots_mean) const;
  // The brightest that a pixel can tell apart: saturation * (0.1 + ambient).
  double white() const { return saturation * (0.1 + ambient); }
  // Declared standard deviation of a disparity in pixels: subpixel_px and, independent of it, what noise in two pictures does to the
  // shift between them, sqrt(2 / pixels of the window) / contrast (the Cramer-Rao bound where brightness changes within a pixel).
  // `contrast`: of texture_of.
  double disparity_deviation(double contrast) const;
  // Declared standard deviation of a depth: it grows with its square.
  double depth_deviation(double depth, double contrast) const;
};

}  // namespace waretwin
