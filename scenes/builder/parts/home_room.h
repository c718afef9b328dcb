// The rooms of a flat: walls between them with doorways, floors of their own, lamps, curtains, carpets.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/kit.h"
#include "scenes/builder/parts/room.h"

namespace waretwin::builder {

constexpr double kPartition = 0.10;  // metres, a wall between rooms

// A wall of kPartition about the line from (x0, y0) to (x1, y1). Openings that begin on the floor are doorways and get a frame.
struct Partition {
  double x0, y0, x1, y1, height;
  std::vector<Opening> openings;
  std::string left = "wall_cream", right = "wall_cream";  // finishes of its sides, looking along it
};
int add_partition(Kit& kit, int parent, const std::string& name, const Partition& wall);

// Floor and ceiling of one room.
int add_floor_area(Kit& kit, int parent, const std::string& name, const Eigen::AlignedBox2d& area, const std::string& finish);
int add_ceiling_area(Kit& kit, int parent, const std::string& name, const Eigen::AlignedBox2d& area, double height);

// A round lamp under the ceiling, 0.4 m across, with its light; z is the ceiling.
void add_round_lamp(Kit& kit, int parent, const Placement& at, double intensity_cd);
int add_floor_lamp(Kit& kit, int parent, const Placement& at);  // 1.55 m, shines by its shade alone
int add_table_lamp(Kit& kit, int parent, const Placement& at);  // for a top, 0.42 m

// On a wall as in room.h: two curtains beside a window of this width, `length` metres from the rod down; z is the rod.
void add_curtains(Kit& kit, int parent, const Placement& at, double width, double length);
// Tiles on a wall, from the placement's z up.
void add_wall_tiles(Kit& kit, int parent, const Placement& at, double width, double height, const std::string& finish);

// Lies on the floor, 6 mm thick; the pattern of the carpet finishes shows whole at 2.0 x 1.4 m.
constexpr double kCarpet = 0.006;
int add_carpet(Kit& kit, int parent, const Placement& at, double length, double width, const std::string& finish);

}  // namespace waretwin::builder
