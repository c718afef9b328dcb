// Kitchen and bathroom: refrigerator, kitchen counter, wall cupboards, toilet, washbasin, bathtub. The placement is the middle of the
// footprint on the floor; fronts look to -y, backs stand at a wall.
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

struct Refrigerator {
  double width = 0.60, depth = 0.64, height = 1.42;
  std::string finish = "enamel";
};
int add_refrigerator(Kit& kit, int parent, const Placement& at, const Refrigerator& fridge);

// Cupboards under a worktop of 0.90 m, with a sink at its left and a hob at its right for somebody who stands at -y.
struct Counter {
  double length = 2.40, depth = 0.62;
  bool sink = true, hob = true;
  std::string front = "kitchen_front";
};
int add_counter(Kit& kit, int parent, const Placement& at, const Counter& counter);
// Hang on a wall; the placement's z is their lower side, 0.65 m high and 0.34 m deep.
int add_wall_cupboards(Kit& kit, int parent, const Placement& at, double length, const std::string& front = "kitchen_front");
int add_pot(Kit& kit, int parent, const Placement& at);

int add_toilet(Kit& kit, int parent, const Placement& at);                                // with its cistern; 0.39 x 0.68 x 0.80 m
int add_washbasin(Kit& kit, int parent, const Placement& at);                             // on a pedestal; 0.56 x 0.44 m
int add_bathtub(Kit& kit, int parent, const Placement& at, double length, double width);  // length along x, the tap at +x

}  // namespace waretwin::builder
