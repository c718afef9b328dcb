// Beds, chairs, armchairs and sofas. The placement is the middle of the footprint on the floor; seats look to -y, a bed's head is at +y.
// Each is one node with everything that belongs to it (mattress, pillows, cushions), so that its cuboid is its own. Whether it counts as
// an object is for the hall to say (Model::set_class).
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

struct Bed {
  double length = 2.06, width = 1.60, headboard = 0.95;  // with the frame; metres
  std::string frame = "oak", linen = "linen_white", blanket = "blanket_blue";
};
int add_bed(Kit& kit, int parent, const Placement& at, const Bed& bed);

struct WoodenChair {
  double width = 0.44, depth = 0.44, seat = 0.45, height = 0.88;
  std::string wood = "oak", cushion = {};  // no cushion where empty
};
int add_wooden_chair(Kit& kit, int parent, const Placement& at, const WoodenChair& chair);

// A sofa for `seats` people; an armchair with one seat.
struct Sofa {
  double width = 2.0, depth = 0.90, height = 0.82;  // of the frame; back cushions reach a little higher
  int seats = 3;
  bool cushions = true;  // two that lie on it
  std::string fabric = "fabric_grey", cushion = "fabric_mustard";
};
int add_sofa(Kit& kit, int parent, const Placement& at, const Sofa& sofa);

// A soft pad, standing on z = 0: flat at its rim, `dz` thick in the middle.
Shape pillow(double dx, double dy, double dz);

}  // namespace waretwin::builder
