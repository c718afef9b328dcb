// How a depth camera's noise is looked for in a recording.
#pragma once

#include "core/fields.h"
#include "sensors/time_of_flight_config.h"

namespace waretwin {

struct NoiseConfig {
  int frames = 60;                  // used, spread evenly over the recording
  int patch_px = 12;                // patches are squares of this many pixels, side by side over the image
  double min_valid_share = 0.8;     // of a patch's pixels
  double max_outlier_sigmas = 6.0;  // a reading farther than this from the plane (robust standard deviations): an edge
  // How much better two planes may describe a patch than one, in variances of an independent reading. Chance makes it 25 at most.
  double max_structure = 30.0;
  double max_incidence_deg = 75.0;
  double range_step_m = 0.25, incidence_step_deg = 15.0;  // of the table's cells
  int min_patches = 20;                                   // of a cell that counts

  // What the time-of-flight law cannot tell apart from noise_m; see TimeOfFlightConfig.
  double reflectivity = 0.5;  // of the typical surface at 850 nm
  double illumination = TimeOfFlightConfig{}.illumination;
  double background = TimeOfFlightConfig{}.background;

  void visit(Fields& f);
};

}  // namespace waretwin
