// The paper's Table 6 with ours beside it.
#pragma once

#include <string>

#include "harness/score/run_score.h"

namespace waretwin {

// Markdown: a row an object (IoU_3D, E_trans in metres, E_rot in degrees) and the average, as mapped and after alignment, then the paper's
// own rows. Objects that do not count are marked and left out of the average.
std::string table6(const ComparedLists& objects, const std::string& title);

}  // namespace waretwin
