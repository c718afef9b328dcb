// waretwin inspect SCENARIO --motion S: what moves, without sensors.
#pragma once

#include "scenes/scenario.h"

namespace waretwin {

// Runs the hall alone for `seconds` of its time, with progress to stderr unless `quiet`, and prints what its belts carried, what became of
// the items, what the vehicle touched, and a digest of where everything ended. Returns the program's exit code: 1 when the vehicle touched
// something or an item fell through a belt.
int inspect_motion(const Scenario& scenario, double seconds, bool quiet);

}  // namespace waretwin
