// Conveyors: the objects that the robot looks for. Each is one node of class "conveyor" with everything that belongs to it and nothing
// that does not (no cabinet, no parcel, no cable), so that its cuboid is its own.
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

// A table-top unit: bright green base rail, aluminium side profiles with a row of bolts, a belt or black rollers on top.
// Its cuboid is exactly length x width x height, standing on the placement's z.
struct TableTopConveyor {
  std::string name = "conveyor";
  double length = 0.60, width = 0.40, height = 0.15;  // x, y, z in metres
  bool rollers = false;
  double roller_pitch = 0.062;
  std::string rail = "green_paint", belt = "rubber_belt", roller = "roller_black";  // finishes
};
int add_table_top_conveyor(Kit& kit, int parent, const Placement& at, const TableTopConveyor& c);

// A floor-standing segment with legs: straight, `length` along x. Its origin is on the floor under its middle.
struct FloorConveyor {
  std::string name = "conveyor";
  double length = 2.0, width = 0.60;  // width over the side frames
  double height = 0.75;               // of the running surface
  bool rollers = true;
  double roller_pitch = 0.10;
  // Finishes; an empty frame is green with rollers and blue with a belt.
  std::string frame = {}, belt = "rubber_belt", roller = "roller_steel";
};
int add_floor_conveyor(Kit& kit, int parent, const Placement& at, const FloorConveyor& c);

// A curve about the placement's origin, from angle 0 (the x axis) to `degrees`, its centre line at `radius`. Tapered look, straight
// rollers.
struct CurveConveyor {
  std::string name = "conveyor_curve";
  double radius = 1.0, width = 0.60, height = 0.75, degrees = 90.0;
  double roller_pitch_deg = 6.0;
  bool belt = false;
  std::string frame = {}, belt_finish = "rubber_belt", roller = "roller_steel";  // as above
};
int add_curve_conveyor(Kit& kit, int parent, const Placement& at, const CurveConveyor& c);

}  // namespace waretwin::builder
