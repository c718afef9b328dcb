// What moves in a hall, each a model of its own with its origin on the ground below its middle and its front along x.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

int add_tote(Kit& kit, int parent, const Placement& at);    // 0.40 x 0.30 x 0.20 m, lidded
int add_person(Kit& kit, int parent, const Placement& at);  // 1.76 m, in stride, with a reflective vest and a helmet
int add_cart(Kit& kit, int parent, const Placement& at);    // a transport vehicle of 1.1 x 0.7 m with a load
int add_block(Kit& kit, int parent, const Placement& at);   // a workpiece as small as a fist

std::vector<std::string> mover_names();
// The model of this name as .glb: carton, tote, person, cart or block. Throws Error for another.
std::string build_mover(const std::string& name);

}  // namespace waretwin::builder
