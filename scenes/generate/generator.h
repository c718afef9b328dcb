// The hall generator: a plan from a seed. What it looks like to a camera is checked by whoever may cast rays (harness/generate).
#pragma once

#include <optional>
#include <vector>

#include "scenes/generate/generate_config.h"
#include "scenes/generate/hall_plan.h"
#include "scenes/generate/route.h"
#include "scenes/generate/vehicle.h"

namespace waretwin::generate {

class Generator {
 public:
  // Throws Error where the size has no room for any hall, and for a number of conveyors in a home.
  explicit Generator(const GenerateConfig& config);

  // Draws a hall with its route; without a value where this draw does not work out. The same config and attempt give the same hall.
  std::optional<HallPlan> draw(int attempt) const;
  // Where else an object, by index, can be looked at (route.h).
  std::vector<Stop> possible_stops(const HallPlan& plan, int attempt, std::size_t object) const;
  // Adds stops to the hall's route.
  void add_stops(HallPlan& plan, int attempt, const std::vector<Stop>& stops) const;

 private:
  RouteWishes wishes(const HallPlan& plan, int attempt) const;

  GenerateConfig config_;
  Vehicle vehicle_;
};

}  // namespace waretwin::generate
