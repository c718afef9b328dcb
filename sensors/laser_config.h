// 2D laser scanners as configuration, with presets.
#pragma once

#include <string>
#include <vector>

#include "core/fields.h"
#include "core/stamp.h"
#include "sensors/mount.h"

namespace waretwin {

// Error of a range: a part that is drawn once per run and a part that is drawn for every beam.
struct LaserNoise {
  bool enabled = true;
  // S300 data sheet: 28 mm at one sigma of which 20 mm are systematic; the rest is the random part.
  double sigma_m = 0.008;      // standard deviation of the random part
  double bias_max_m = 0.02;    // the systematic part is uniform in [-bias_max, bias_max], constant in a run
  double sigma_far_m = 0.008;  // standard deviation at the scanner's farthest range; it grows evenly
  double grows_from_m = 30.0;  // from here on
  // Standard deviation of the random part of a range in metres.
  double deviation(double range, double range_max) const;
  void visit(Fields& f);
};

// The light of a beam. Signals are relative: 1 comes from a white diffuse surface seen straight on from 1 m.
struct LaserSpot {
  bool mixed = true;     // false: a beam without width
  bool dropouts = true;  // false: every surface is bright enough
  // SICK's sibling scanners: 8 mm + 15 mrad * distance.
  double diameter_m = 0.008;
  double divergence_rad = 0.015;
  double merge_m = 0.3;  // echoes nearer to each other than this become one
  // Retroreflectors drive the receiver beyond what it corrects for: it answers too early, the more so the stronger the echo. The shift
  // grows with the logarithm of the signal, from nothing at retro_least_signal to retro_shift_m at retro_full_signal. S300: "with
  // retroreflectors ... a supplement of 200 mm" (operating instructions 8010948, section 5.3, measurement errors caused by reflection);
  // the curve between is ours.
  bool retroreflectors = true;  // false: they are bright and nothing else
  double retro_shift_m = 0.2;
  double retro_least_signal = 0.1, retro_full_signal = 30.0;
  double min_signal = 0.001;  // about what 1.8 % reflectivity gives at 4 m, or a white wall at 8 m under 86 deg
  // Where the scanner would see its own vehicle: from, to, from, to ... in degrees of the scanner's frame (0 = forward, counter-clockwise).
  std::vector<double> masked_deg;
  bool masks(double angle) const;  // radians
  // How much too short a range is whose echo has this much of its signal from retroreflectors; metres, 0 with `retroreflectors` off.
  double retro_shift(double signal) const;
  void visit(Fields& f);
};

// The defaults are those of preset sick_s300 (S300 Expert), mounted as in the paper's section 4.3: 0.3 m high at a front corner; offsets
// and yaw come from the authors' own configuration.
struct LaserConfig {
  std::string preset = "sick_s300";
  int beams = 541;
  double field_deg = 270.0;  // symmetric about the forward axis, first beam on the right
  double rate_hz = 25.0;     // mirror turns a second; a beam is measured when the mirror points at it
  double range_min_m = 0.05, range_max_m = 30.0;
  double range_step_m = 0.01;  // resolution of the output; 0 = none
  LaserSpot spot;
  LaserNoise noise;
  Mount mount = {.x_m = 0.275, .y_m = 0.2, .z_m = 0.3, .yaw_deg = 43.9};

  // Presets: sick_s300 (S300 Expert), sick_tim571 (TiM571), hokuyo_utm30lx (UTM-30LX), each from its data sheet; ideal (the S300's geometry
  // without error). Throws Error naming the known ones.
  static LaserConfig make(const std::string& preset);
  double angle_min() const;        // radians
  double angle_increment() const;  // radians
  Stamp beam_interval() const;     // ns between neighbouring beams of one turn
  // A `preset` that changes sets all other fields but the mount, before those that follow it.
  void visit(Fields& f);
};

}  // namespace waretwin
