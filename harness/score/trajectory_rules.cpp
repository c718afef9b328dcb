#include "harness/score/trajectory_rules.h"

#include <cmath>
#include <sstream>

namespace waretwin {

void TrajectoryRules::visit(Fields& f) {
  f("alignment", alignment, "se3: the estimate is laid over the truth before the ATE; none: as it is", {.choices = {"se3", "none"}});
  f("max_time_difference_s", max_time_difference_s, "stamps this near belong together", {.min = 0, .max = 3600});
  f("time_offset_s", time_offset_s, "added to the stamps of the estimate", {.min = -5e9, .max = 5e9});
  f("rpe_delta", rpe_delta, "how far apart the poses are whose motion the RPE compares", {.min = 1e-9, .max = 1e9});
  f("rpe_unit", rpe_unit, "unit of rpe_delta; metres and degrees along the path", {.choices = {"frames", "metres", "degrees", "seconds"}});
  f("rpe_pairs", rpe_pairs, "consecutive: each pair starts where the last one ends; all: a pair from every pose on",
    {.choices = {"consecutive", "all"}});
  f("rpe_tolerance", rpe_tolerance, "rpe_pairs all, but by frames: share of rpe_delta by which a pair may be off", {.min = 0, .max = 1});
  f("rpe_from", rpe_from, "whose metres and degrees decide on the pairs", {.choices = {"estimate", "truth"}});
  std::ostringstream delta;
  delta << rpe_delta;
  if (rpe_unit == "frames" && rpe_delta != std::floor(rpe_delta)) {
    f.reject("rpe_delta", delta.str() + " frames; expected a whole number");
  }
  // evo has the same bound: all pairs are chosen by the angle between two poses, which knows no half turns.
  if (rpe_unit == "degrees" && rpe_delta > 180.0) f.reject("rpe_delta", delta.str() + " degrees; expected at most 180");
}

}  // namespace waretwin
