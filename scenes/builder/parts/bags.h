// Bags that stand on floors and seats. Each is one node, so that its cuboid is its own; fronts look to -y.
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

int add_backpack(Kit& kit, int parent, const Placement& at, const std::string& canvas);  // 0.31 x 0.29 x 0.49 m
int add_shopping_bag(Kit& kit, int parent, const Placement& at);                         // of paper, filled; 0.33 x 0.19 x 0.40 m
int add_handbag(Kit& kit, int parent, const Placement& at, const std::string& leather);  // 0.36 x 0.15 x 0.40 m with its handle

}  // namespace waretwin::builder
