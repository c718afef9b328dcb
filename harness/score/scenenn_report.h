// Scores of sequences as text and as JSON, with what the paper publishes beside them. docs/metrics.md has every key.
#pragma once

#include <string>

#include "harness/score/scenenn_score.h"

namespace waretwin {

// Markdown: Tables 1 to 3 of the paper as printed, our sequences as further rows; Tables 4 and 5 where a sequence has times. Percent.
std::string scenenn_tables(const SceneNnScore& score, const std::string& title);

// The same numbers unrounded, as fractions, and the published ones as printed.
std::string scenenn_json(const SceneNnScore& score);

}  // namespace waretwin
