// What stands together in a home: a bed with its bedside tables, a desk with its chair, a sofa with a low table, a table among chairs.
#pragma once

#include <string>
#include <vector>

#include "scenes/generate/dice.h"
#include "scenes/generate/hall_plan.h"

namespace waretwin::generate {

// One thing of a group. With a class it is a true object.
struct GroupPiece {
  Item item;
  builder::Placement at;
  std::string class_name, kind;
};

// In a frame of its own: its back is the line y = 0, its front looks to -y. Pieces may stand on one another.
struct FurnitureGroup {
  std::vector<GroupPiece> pieces;
  double free_in_front = 0.85;  // metres of floor that stay free before it
  double free_beside = 0.0;     // and on one of its sides, in its whole depth
  bool island = false;          // stands in the room, free all round; the origin is its middle
};

// Names of finishes in HallPlan::finishes that a home's furniture is drawn from.
struct HomeFinishes {
  std::vector<std::string> woods, fabrics, blankets, carpets, fronts;
};

FurnitureGroup draw_bed_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_sofa_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_armchair(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_television_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_dining_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_desk_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_kitchen_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_bookcase_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_chest_group(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_wardrobe(Dice& dice, const HomeFinishes& finishes);
FurnitureGroup draw_toilet(Dice& dice);
FurnitureGroup draw_washbasin(Dice& dice);
FurnitureGroup draw_bathtub(Dice& dice);
FurnitureGroup draw_bag(Dice& dice);
FurnitureGroup draw_house_plant(Dice& dice);  // or a floor lamp

// Puts a group with its back to a wall, or an island into the room, where it fits; its objects are named after their class ("chair_3").
// False where no place is found; the plan is then as it was.
bool stand_group(HallPlan& plan, const FurnitureGroup& group, Dice& dice);

}  // namespace waretwin::generate
