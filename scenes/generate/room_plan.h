// An empty room, drawn at random: walls with windows, doors and gates, lamps, light, and the looks of everything that varies.
#pragma once

#include "scenes/generate/dice.h"
#include "scenes/generate/hall_plan.h"
#include "scenes/generate/station.h"

namespace waretwin::generate {

// Floor, walls, lamps and lighting of a room of this size. Openings that people and vehicles come through are kept free; the
// first is where a route begins.
void draw_room(HallPlan& plan, double length, double width, double height, Dice& dice);

// Colours, wear and reflectivities of floor, walls and conveyors; returns the names of what conveyors are made of.
ConveyorFinishes draw_finishes(HallPlan& plan, Dice& dice);

// What hangs on walls, where nothing stands before it: posters, ducts, radiators, boxes.
void decorate_walls(HallPlan& plan, Dice& dice);
// The same for rooms that people live in.
void hang_paintings(HallPlan& plan, Dice& dice);

}  // namespace waretwin::generate
