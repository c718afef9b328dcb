// Bare rooms for quick tests: plain walls and floor, table-top conveyors, a few cartons.
#pragma once

#include <optional>

#include "scenes/generate/generate_config.h"
#include "scenes/generate/hall_plan.h"

namespace waretwin::generate {

// One draw, still without a route. Without a value where this draw has no room for all conveyors.
std::optional<HallPlan> draw_flat(const GenerateConfig& config, int attempt);

}  // namespace waretwin::generate
