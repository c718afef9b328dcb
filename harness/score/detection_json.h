// A detection score as JSON, for the files that hold one.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/score/detection_score.h"

namespace waretwin {

// All figures, overall and by class, and the list of confusions, under the keys of docs/detection.md.
void add_figures(nlohmann::ordered_json& json, const DetectionScore& score);

}  // namespace waretwin
