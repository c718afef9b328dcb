// Warehouse storage: pallets, cartons, racks, barriers.
#pragma once

#include <string>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

constexpr double kPalletLength = 1.2, kPalletWidth = 0.8, kPalletHeight = 0.144;  // EPAL 1

int add_pallet(Kit& kit, int parent, const Placement& at);  // standing on the placement, 1.2 m along x

// Cartons in rows (x), columns (y) and layers, each a little turned; `key` varies them. The middle of the stack's foot is the placement.
int add_carton_stack(Kit& kit, int parent, const Placement& at, int rows, int columns, int layers, double dx, double dy, double dz,
                     const std::string& key);
int add_carton(Kit& kit, int parent, const Placement& at, double dx, double dy, double dz);

// A pallet with its load: kind 0 cartons, 1 wrapped cartons, 2 bins, 3 empty pallets stacked.
int add_loaded_pallet(Kit& kit, int parent, const Placement& at, int kind, const std::string& key);

// A pallet rack along x: `bays` of 2.7 m, `levels` beams above the floor, depth 1.1 m, with loads (also on the floor) drawn from `key`.
// Front to -y; the placement is the middle of the rack's foot.
struct Rack {
  int bays = 4, levels = 3;
  double level_height = 1.5;
  double fill = 0.8;  // share of pallet places that are taken
  std::string key = "rack";
};
int add_rack(Kit& kit, int parent, const Placement& at, const Rack& rack);

int add_barrier(Kit& kit, int parent, const Placement& at, double length);  // yellow guard rail along x
int add_post(Kit& kit, int parent, const Placement& at);                    // yellow-black bollard
int add_column(Kit& kit, int parent, const Placement& at, double height);   // steel column with a guard
int add_fence(Kit& kit, int parent, const Placement& at, double length);    // mesh fence along x, 1.8 m high
int add_hanging_sign(Kit& kit, int parent, const Placement& at, int number);

}  // namespace waretwin::builder
