// Settings by which two trajectories are compared, in the words of the TUM RGB-D benchmark's tools and of evo.
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

struct TrajectoryRules {
  std::string alignment = "se3";  // of the positions, before the ATE: se3 or none; the RPE needs none
  double max_time_difference_s = 0.01;
  double time_offset_s = 0.0;  // added to the stamps of the estimate

  // Which poses the RPE compares: those that are rpe_delta apart, in rpe_unit.
  double rpe_delta = 1.0;
  std::string rpe_unit = "frames";        // frames, metres (along the path), degrees, seconds
  std::string rpe_pairs = "consecutive";  // consecutive: each pair starts where the last one ends; all: a pair from every pose on
  double rpe_tolerance = 0.1;             // rpe_pairs all, but by frames: a pair may be off by this share of rpe_delta
  std::string rpe_from = "estimate";      // whose metres and degrees count: estimate or truth

  void visit(Fields& f);
};

}  // namespace waretwin
