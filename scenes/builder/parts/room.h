// The room itself: floor, walls with openings, ceiling, lamps, ducts, markings and what hangs on walls.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

// A rectangular opening in a wall: from `along` (metres from the wall's start) and `above` the floor.
struct Opening {
  double along, above, width, height;
};

// A wall of no thickness from (x0, y0) to (x1, y1); the room is on its left.
struct Wall {
  double x0, y0, x1, y1, height;
  std::vector<Opening> openings;
  std::string finish = "wall_paint";
};
int add_wall(Kit& kit, int parent, const std::string& name, const Wall& wall);

int add_floor(Kit& kit, int parent, double length, double width, const std::string& finish = "concrete_floor");  // centred on the origin
int add_ceiling(Kit& kit, int parent, double length, double width, double height);

// A strip of tape on the floor along a polyline (metres), `width` wide.
void add_floor_tape(Kit& kit, int parent, const std::string& name, const std::vector<Vector2d>& path, double width,
                    const std::string& finish);
// A track of tyre rubber.
void add_tyre_marks(Kit& kit, int parent, const std::vector<Vector2d>& path);

// A luminaire 1.2 x 0.3 m under the ceiling with its light; z is its lower side.
void add_ceiling_lamp(Kit& kit, int parent, const Placement& at, double intensity_cd);

// Things on walls. The placement is the lower middle of the thing's back; +y of the placement points into the room.
void add_window(Kit& kit, int parent, const Placement& at, double width, double height);
void add_door(Kit& kit, int parent, const Placement& at, double width, double height);
void add_gate(Kit& kit, int parent, const Placement& at, double width, double height);
void add_wall_picture(Kit& kit, int parent, const Placement& at, double width, double height, const std::string& finish);
void add_cable_duct(Kit& kit, int parent, const Placement& at, double length);  // along x
void add_radiator(Kit& kit, int parent, const Placement& at, double length);
void add_switch_box(Kit& kit, int parent, const Placement& at);
void add_fire_extinguisher(Kit& kit, int parent, const Placement& at);

}  // namespace waretwin::builder
