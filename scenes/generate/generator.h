// The hall generator: a plan from a seed. What it looks like to a camera is checked by whoever may cast rays (harness/generate).
#pragma once

#include <optional>
#include <vector>

#include "scenes/generate/generate_config.h"
#include "scenes/generate/hall_plan.h"
#include "sensors/camera_config.h"

namespace waretwin::generate {

class Generator {
 public:
  // Throws Error where the size has no room for so many conveyors at all.
  Generator(const GenerateConfig& config, const CameraConfig& camera);

  // Draws a hall with its route; without a value where this draw does not work out. The same config and attempt give the same hall.
  std::optional<HallPlan> draw(int attempt) const;
  // Plans the hall's route anew, looking closer at conveyors by index: effort 0 as at first, each step from more places. False where that
  // finds no route; the plan's own one then stays.
  bool look_closer(HallPlan& plan, int attempt, const std::vector<int>& effort) const;

 private:
  GenerateConfig config_;
  CameraConfig camera_;
};

}  // namespace waretwin::generate
