// Random furnished rooms, as one lives in: a living room, a bedroom, a study, a kitchen, a bathroom, or most of it in one room.
#pragma once

#include <optional>

#include "scenes/generate/generate_config.h"
#include "scenes/generate/hall_plan.h"

namespace waretwin::generate {

// One draw, still without a route. Without a value where this draw has no room for what the kind of room needs.
std::optional<HallPlan> draw_home(const GenerateConfig& config, int attempt);

// The classes of a home's objects, those of the paper's section 4.2.
const std::vector<std::string>& home_classes();

}  // namespace waretwin::generate
