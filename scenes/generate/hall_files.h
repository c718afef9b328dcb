// A plan as files: the hall's model and its scenario.
#pragma once

#include <string>

#include "scenes/generate/hall_plan.h"

namespace waretwin::generate {

// hall.glb. The same plan gives the same bytes.
std::string build_glb(const HallPlan& plan);

// scenario.yaml, which names hall.glb beside it: light, vehicle, route with what each stop looks at, the paper's sensors.
std::string scenario_text(const HallPlan& plan, std::uint64_t seed);

}  // namespace waretwin::generate
