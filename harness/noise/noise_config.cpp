#include "harness/noise/noise_config.h"

namespace waretwin {

void NoiseConfig::visit(Fields& f) {
  f("frames", frames, "frames used, spread evenly", {.min = 1, .max = 1000});
  f("patch_px", patch_px, "side of a patch in pixels", {.min = 8, .max = 64});
  f("min_valid_share", min_valid_share, "least share of a patch's pixels with a reading", {.min = 0.5, .max = 1});
  f("max_outlier_sigmas", max_outlier_sigmas, "a reading farther off the plane makes a patch an edge", {.min = 3, .max = 100});
  f("max_structure", max_structure, "how much better two planes may describe a patch than one, in variances of a reading",
    {.min = 20, .max = 10000});
  f("max_incidence_deg", max_incidence_deg, "surfaces seen at a flatter angle are left out", {.min = 1, .max = 85});
  f("range_step_m", range_step_m, "width of the table's cells", {.min = 0.01, .max = 10});
  f("incidence_step_deg", incidence_step_deg, "width of the table's cells", {.min = 1, .max = 90});
  f("min_patches", min_patches, "cells with fewer patches are left out", {.min = 8, .max = 1e6});
  f("reflectivity", reflectivity, "of the typical surface at 850 nm, for the time-of-flight law", {.min = 0.01, .max = 2});
  f("illumination", illumination, "TimeOfFlightConfig's, for the time-of-flight law", {.min = 1e-3, .max = 100});
  f("background", background, "TimeOfFlightConfig's, for the time-of-flight law", {.min = 0, .max = 100});
}

}  // namespace waretwin
