// The halls that are shipped, composed of parts.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

// The production cell of the paper's section 4.3: 12 x 6 m, four table-top conveyors. Origin in the middle of the floor, x along 12 m.
void build_agiprobot(Kit& kit);
// A warehouse of 40 x 25 m with floor-standing conveyors. Origin in the middle of the floor, x along 40 m.
void build_warehouse(Kit& kit);
// A furnished flat of 9 x 7 m that stands in for the rooms of SceneNN (section 4.2): living room with kitchen, bedroom, bathroom, study.
// Origin in the middle of the floor, x along 9 m.
void build_flat(Kit& kit);

std::vector<std::string> hall_names();

struct HallFile {
  std::string name;  // hall.glb, carton.glb ...
  std::string glb;
};
// The hall's own model and those of what moves in it. The same name gives the same bytes. Throws Error for a name that is not known.
std::vector<HallFile> build_hall(const std::string& name);

}  // namespace waretwin::builder
