// How well boxes are found, for choosing among a training's epochs; harness/score has the full family.
#pragma once

#include <vector>

#include "harness/train/region_boxes.h"
#include "harness/train/sample.h"

namespace waretwin::train {

// Area under the precision-recall curve (precision made falling) at one IoU, averaged over the classes that the truth has. Within a picture
// the better box takes the object that it overlaps most and that is still free; boxes that reach `iou` with an ignored one alone do not
// count. 0 without truth.
double average_precision(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, int classes,
                         float iou);

// The score from which on detections count for the best balance of precision and recall (F1, all classes together): the middle, as log
// odds, of all scores that are within 1 % of the best. 0.5 where nothing is found.
double balanced_score(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, int classes,
                      float iou);

// Median over correctly found boxes (IoU >= 0.5) of the mean distance between their four sides and the truth's, in pixels of a picture of
// that size; 0 where none is found.
double median_side_error(const std::vector<std::vector<ScoredBox>>& found, const std::vector<std::vector<TruthBox>>& truth, double width,
                         double height);

}  // namespace waretwin::train
