// Tables, cupboards and shelves of flats, and what stands on them. The placement is the middle of the footprint on the floor (of things
// for tops: on the top); fronts look to -y.
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

// Four legs, an apron, a top: a dining table, a low table with a shelf, a desk with drawers on one side.
struct WoodenTable {
  double width = 1.40, depth = 0.85, height = 0.74;
  std::string wood = "oak";
  bool shelf = false;    // a board between the legs
  bool drawers = false;  // a block of three at its right end, for somebody who sits at -y
};
int add_wooden_table(Kit& kit, int parent, const Placement& at, const WoodenTable& table);

// Drawers one above another in `columns`: a bedside table, a chest, a low board for a television.
struct Chest {
  double width = 0.45, depth = 0.40, height = 0.50;
  int columns = 1, rows = 2;
  std::string body = "oak", front = "oak";
};
int add_chest(Kit& kit, int parent, const Placement& at, const Chest& chest);

struct Wardrobe {
  double width = 1.80, depth = 0.60, height = 2.05;
  std::string body = "pine", front = "white_lacquer";
};
int add_wardrobe(Kit& kit, int parent, const Placement& at, const Wardrobe& wardrobe);

// Open to the front, empty: books are placed on its boards. Board `i` of `boards` has its upper side at board_top(i); the last one is the
// top of the bookcase.
struct Bookcase {
  double width = 0.90, depth = 0.30, height = 1.10;
  int boards = 4;
  std::string wood = "oak";
  double board_top(int i) const { return 0.08 + (height - 0.08) * i / (boards - 1); }
};
int add_bookcase(Kit& kit, int parent, const Placement& at, const Bookcase& bookcase);

// On two feet, for a top. `width` of the set.
int add_television(Kit& kit, int parent, const Placement& at, double width, const std::string& picture = "screen_landscape");

int add_fruit_bowl(Kit& kit, int parent, const Placement& at);
int add_vase(Kit& kit, int parent, const Placement& at);

}  // namespace waretwin::builder
