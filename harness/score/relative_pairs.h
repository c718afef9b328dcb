// Which poses of a trajectory the relative pose error compares, chosen as evo does (evo_rpe's delta, delta unit and all pairs).
//
//             consecutive                                            all
//   frames    0 and d, d and 2d ..                                   i and i + d
//   metres    the path has grown by d since the last chosen pose;    i and the later pose whose path from i is nearest to d,
//             the first chosen one lies d after the start            where that is within the tolerance
//   degrees   the turned angle has grown by d since the last;        all pairs whose orientations differ by d within the tolerance
//             the start is chosen, too
//   seconds   as degrees, by stamps                                  as metres, by stamps
//
// evo has no seconds, and TUM's evaluate_rpe.py has all pairs alone; docs/metrics.md lists the differences.
#pragma once

#include <cstddef>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"
#include "harness/score/trajectory_rules.h"

namespace waretwin {

struct PosePair {
  std::size_t from = 0, to = 0;  // from < to
  bool operator==(const PosePair&) const = default;
};

// Pairs in order of `from`, then `to`. Stamps are those of the poses, rising; without stamps the unit cannot be seconds. Empty where no
// poses are so far apart. Throws Error for more than 20 million pairs.
std::vector<PosePair> relative_pairs(const std::vector<Pose>& poses, const std::vector<Stamp>& stamps, const TrajectoryRules& rules);

}  // namespace waretwin
