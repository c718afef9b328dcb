// Putting stations and things into rooms.
#pragma once

#include <vector>

#include "scenes/generate/dice.h"
#include "scenes/generate/hall_plan.h"
#include "scenes/generate/station.h"

namespace waretwin::generate {

struct Standing {
  Station station;
  builder::Placement at;
};

enum class Where {
  kWall,    // its back to a wall
  kIsland,  // in the middle, turned anyhow, vehicles all round it
  kLine     // in the middle, along the walls by a few degrees, vehicles all round it
};

// Puts a station somewhere, with what it needs kept free; false where no place is found.
bool stand_somewhere(HallPlan& plan, std::vector<Standing>& standing, Station station, Where where, Dice& dice);

// On and beside a station: a table with things on it, a stack of bins, a board that leans on it. `clutter` from 0 to 1.
void add_neighbours(HallPlan& plan, const Standing& s, double clutter, Dice& dice);

// Puts a thing with its back to a wall; false where no place is found. `gap` metres behind it.
bool stand_at_wall(HallPlan& plan, const Item& item, double gap, builder::Placement& at, Dice& dice);

// Things along the walls and near them, as many as find a place.
void add_wall_items(HallPlan& plan, int count, Dice& dice);
void add_floor_items(HallPlan& plan, int count, Dice& dice);

// Docks before stations, a lane.
void add_floor_marks(HallPlan& plan, const std::vector<Standing>& standing, Dice& dice);

}  // namespace waretwin::generate
