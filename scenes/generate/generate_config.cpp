#include "scenes/generate/generate_config.h"

namespace waretwin::generate {

void GenerateConfig::visit(Fields& f) {
  f("style", style,
    "cell: a production cell like the AgiProbot's; warehouse: conveyor lines and racks; flat: a bare room for quick tests; home: "
    "a furnished room",
    {.choices = {"cell", "warehouse", "flat", "home"}});
  f("seed", seed, "the same seed gives the same hall");
  f("length_m", length_m, "of the floor along x; 0: drawn", {.min = 0, .max = 200});
  f("width_m", width_m, "of the floor along y; 0: drawn", {.min = 0, .max = 200});
  f("conveyors", conveyors, "how many; 0: drawn (a cell has 3 to 6); a home has none", {.min = 0, .max = 200});
  f("coverage", coverage, "share of each object's viewable surface that depth views along the route must see; 0: any",
    {.min = 0, .max = 0.95});
  f("clutter", clutter, "from 0, bare stations, to 1, crowded; negative: drawn", {.min = -1, .max = 1});
  f("close_share", close_share, "share of cells in which two conveyors stand 5-30 cm apart", {.min = 0, .max = 1});
  f("clearance_m", clearance_m, "between the vehicle, however it is turned, and everything else", {.min = 0.03, .max = 1});
  f("wait_s", wait_s, "how long the vehicle stands at each stop", {.min = 0.1, .max = 60});
}

}  // namespace waretwin::generate
