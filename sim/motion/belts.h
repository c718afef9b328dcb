// Conveyors that run: their surfaces as bodies whose contacts move, and a measure of how well they carry.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "scenes/motion_config.h"
#include "sim/motion/belt_surface.h"
#include "sim/motion/items.h"

namespace waretwin {

struct Belt {
  BeltSurface surface;
  BeltConfig config;
  BodyRole role, guard_role;
  double speed_mps = 0.0;  // now
  double steady_s = 0.0;   // how long it has run at the speed it is to run at
  // A ride is the time in which it alone carries an item at a steady speed, less the first half second. Speeds of items over the surface's:
  // summed over all samples of all rides, and the mean of the ride that is farthest from 1.
  double ratio_sum = 0.0, worst_ride = 1.0;
  long samples = 0;

  double wanted_speed(double time_s) const;
};

class Belts {
 public:
  // Throws Error; see find_belt_surfaces.
  Belts(BulletWorld& world, const RayCaster& ray_caster, const MotionConfig& config);

  void run(double time_s, double step_s);     // before a step that ends at time_s
  void measure(Items& items, double step_s);  // after it
  const std::deque<Belt>& all() const { return belts_; }
  bool is_belt(int object) const;  // index into Scene::objects

 private:
  void add_bodies(BulletWorld& world, Belt& belt, int index);
  void end_ride(Item& item);

  std::deque<Belt> belts_;                    // keeps addresses
  std::vector<std::pair<int, int>> carried_;  // in the last step: index of an item, index of a belt below it
};

}  // namespace waretwin
