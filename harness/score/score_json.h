// score.json as text; the keys are those of docs on the run's folder, on which other tools rely.
#pragma once

#include <string>

#include "harness/score/run_score.h"

namespace waretwin {

inline constexpr int kScoreSchema = 1;

// Numbers that do not exist (a mean over nothing) are null.
std::string score_json(const RunScore& score);

// What `waretwin score` writes about two lists of objects: schema, version, objects, summary, and the same after alignment.
std::string score_json(const ComparedLists& objects);

}  // namespace waretwin
