// What moves in a hall, each a model of its own with its origin on the ground below its middle and its front along x.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

int add_tote(Kit& kit, int parent, const Placement& at);    // 0.40 x 0.30 x 0.20 m, lidded
int add_person(Kit& kit, int parent, const Placement& at);  // 1.76 m, in stride, with a reflective vest and a helmet
int add_cart(Kit& kit, int parent, const Placement& at);    // a transport vehicle of 1.1 x 0.7 m with a load
// The mapping vehicle itself, in its frame B: a low base of 0.9 x 0.6 m with room for the laser at its front left corner, a conveyor of its
// own on an aluminium frame behind, and a crossbar at 1.4 m that carries the camera.
int add_vehicle(Kit& kit, int parent, const Placement& at);
int add_block(Kit& kit, int parent, const Placement& at);  // a workpiece as small as a fist

// A calibration board of 0.80 x 0.59 m with 9 x 6 inner corners, 70 mm apart. The middle of its printed face is the origin, x points out of
// it.
int add_board(Kit& kit, int parent, const Placement& at);
// What holds it by the back: a tripod whose head is at the board's origin, 0.42 m above the floor.
int add_board_stand(Kit& kit, int parent, const Placement& at);

std::vector<std::string> mover_names();
// The model of this name as .glb: carton, tote, person, cart, block, vehicle, board or stand. Throws Error for another.
std::string build_mover(const std::string& name);

}  // namespace waretwin::builder
