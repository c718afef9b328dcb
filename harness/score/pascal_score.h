// Average precision as the Pascal VOC challenge defines it (Everingham et al. 2010; development kit 2012), at IoU 0.5.
#pragma once

#include <optional>
#include <vector>

#include "harness/score/scored_boxes.h"

namespace waretwin {

// Nothing for a class without objects to be found; means are over the others.
struct PascalFigures {
  std::optional<double> eleven_point;  // until 2009: mean of the highest precision at recall 0, 0.1 .. 1 or beyond
  std::optional<double> every_point;   // from 2010: area under the precision-recall curve made monotone
};

struct PascalScore {
  PascalFigures all;
  std::vector<PascalFigures> classes;  // by class index
};

// As in the kit, a detection stands for the true box it overlaps most, found already or not; ignored boxes are its "difficult" ones.
// Boxes are continuous: the kit's extra pixel of width and height is left out.
PascalScore score_pascal(const std::vector<ScoredPicture>& pictures, int classes);

}  // namespace waretwin
