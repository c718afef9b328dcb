// What `waretwin generate` is asked for.
#pragma once

#include <cstdint>
#include <string>

#include "core/fields.h"

namespace waretwin::generate {

struct GenerateConfig {
  std::string style = "cell";            // cell, warehouse, flat or home
  std::uint64_t seed = 1;                // of the hall, and of the scenario's sensors
  double length_m = 0.0, width_m = 0.0;  // of the floor; 0: drawn
  int conveyors = 0;                     // 0: drawn
  double coverage = 0.8;                 // share of each object's viewable surface that some depth view along the route must see
  double clutter = -1.0;                 // 0: bare stations, 1: crowded; negative: drawn
  double close_share = 0.25;             // share of cells with two conveyors 5-30 cm apart
  double clearance_m = 0.10;             // between the vehicle, however it is turned, and everything else
  double wait_s = 1.0;                   // at each stop
  void visit(Fields& f);
};

}  // namespace waretwin::generate
