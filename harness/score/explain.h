// What is wrong with a mapped object, in words that a person can act on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/score/object_score.h"

namespace waretwin {

struct Explanation {
  std::optional<int> truth_id, map_id;  // at least one
  std::string text;                     // "never mapped: ...", one line without a full stop
};

// One line for each true object that was not matched or is worse than a pair at `good_iou`, and for each mapped object without a partner:
// in the order of the truth, false positives last. A true object that does not count is named as half seen. Reasons come from the two lists
// alone: where faces lie against the true ones, what else stands there.
std::vector<Explanation> explain(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth,
                                 const ObjectListScore& score, const ScoringRules& rules = {}, double good_iou = 0.75);

}  // namespace waretwin
