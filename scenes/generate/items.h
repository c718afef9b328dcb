// What stands about in halls, drawn at random: sizes, kinds and fillings vary. Fronts look to -y.
#pragma once

#include <string>

#include "scenes/generate/dice.h"
#include "scenes/generate/hall_plan.h"

namespace waretwin::generate {

// Things that stand free on the floor: chairs, bins, cartons, trolleys, pallets with a load ...
Item draw_floor_item(Dice& dice);
// Things that stand with their back to a wall: shelves, tables, cabinets, leaning panels.
struct WallItem {
  Item item;
  double top_width = 0.0, top_depth = 0.0, top = 0.0;  // a surface to put things on, in the middle of the item; 0: none
  bool seat = false;                                   // a chair belongs in front of it
};
WallItem draw_wall_item(Dice& dice, double room_height);
// A board that leans to +y.
Item draw_leaning_panel(Dice& dice);
Item chair(Dice& dice);
Item bin_stack(Dice& dice);
Item table(double width, double depth, double height, const std::string& top, bool shelf);
Item cabinet(double width, double depth, double height, bool drawers);
Item robot_arm(Dice& dice);
Item monitor(Dice& dice);
Item loaded_pallet(Dice& dice);

// A surface to put things on: the middle of it, level.
struct Top {
  builder::Placement at;
  double width = 0.0, depth = 0.0;
};
// Puts up to `count` small things (a robot arm, bins, tools, a screen, cartons) on a surface, `margin` off what stands there.
void furnish(HallPlan& plan, const Top& top, int count, double margin, Dice& dice);

}  // namespace waretwin::generate
