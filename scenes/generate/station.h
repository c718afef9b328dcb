// A station: one conveyor or two neighbours with what they stand on, in a frame of their own. The origin lies on the floor under the
// middle; vehicles come from -y.
#pragma once

#include <vector>

#include "scenes/generate/dice.h"
#include "scenes/generate/hall_plan.h"
#include "scenes/generate/items.h"

namespace waretwin::generate {

struct Station {
  std::vector<PlannedObject> conveyors;
  std::vector<PlacedItem> supports;
  std::vector<Top> tops;
  Eigen::AlignedBox2d footprint;
  // How far beyond its footprint to the left, right and front the floor must stay free, so that a vehicle can look at it.
  double free_beside = 0.5, free_in_front = 1.5;
  bool sides_matter = false;  // it must be seen from both sides too: vehicles drive there
};

// The finishes that a hall's conveyors are drawn from: names in HallPlan::finishes.
struct ConveyorFinishes {
  std::vector<std::string> rails, belts, rollers;
};

// `count` conveyors (1 or 2) on a cabinet or table; two stand `apart` metres from each other.
Station draw_table_top_station(Dice& dice, const ConveyorFinishes& finishes, int count, double apart);
// `count` floor-standing segments in line, straight or curved.
Station draw_floor_station(Dice& dice, const ConveyorFinishes& finishes, int count, double apart);

// A line of `count` floor-standing segments, 1-3 cm apart as bolted ones nearly are, straight and curved, all of one width and height.
Station draw_line(Dice& dice, const ConveyorFinishes& finishes, int count);

// The station's conveyors, supports and floor marks go into the plan at a pose; names count on from the plan's conveyors.
void place_station(HallPlan& plan, const Station& station, const builder::Placement& at);

}  // namespace waretwin::generate
