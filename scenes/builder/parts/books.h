// Books: a row on a board, a pile. Each is one node, so that its cuboid is its own.
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

// Upright books side by side along x, their backs to -y at about -0.1; `key` varies thickness, height and colour. None is higher than
// `height`. The row is at most `length` long.
int add_book_row(Kit& kit, int parent, const Placement& at, double length, double height, const std::string& key);

// Books that lie on one another, the largest below, a little turned.
int add_book_pile(Kit& kit, int parent, const Placement& at, int count, const std::string& key);

}  // namespace waretwin::builder
