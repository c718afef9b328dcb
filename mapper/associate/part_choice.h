// Which parts of what was seen in an object's boxes are the object.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/associate/box_views.h"
#include "mapper/associate/evidence_config.h"

namespace waretwin {

// Cells that hang together, about join_m large.
struct EvidencePart {
  std::vector<Eigen::Vector3f> cells_W;  // their centres, metres
  double hits = 0.0;                     // of rays that speak for the object
  // In (0, 1]: of the cells of the body that it is a piece of. The rest was seen outside the boxes: a wall goes on there.
  double share = 1.0;
  ShownBoxes shown;  // where the views show it; empty where it is too small to matter
};

// Indices of the parts that together match the boxes of `views` best. Each of those that match best alone is tried for the first one;
// others join it one by one, always the one with which the boxes are matched best, as long as the match rises by bridge_gain and the part
// lies within bridge_m of those before it and is no smaller piece than bridge_share of its body. A first one without which the
// rest matches as well is left out again. Without views: the one with most hits. `parts` is not empty.
std::vector<std::size_t> choose_parts(const std::vector<EvidencePart>& parts, const BoxViews& views, const EvidenceConfig& config);

}  // namespace waretwin
