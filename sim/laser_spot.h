// What the beams of a laser scanner bring back: light from a spot, not from a point.
#pragma once

#include <functional>
#include <string>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/laser_config.h"
#include "sensors/measurements.h"
#include "sim/ray_caster.h"
#include "sim/surfaces.h"

namespace waretwin {

// One turn that starts at `stamp`; each beam leaves from where the laser is when the mirror points at it (X_WL: the laser at any time). A
// beam is looked at seven times, in its middle and on a ring of two thirds of the spot's radius, and each look is an echo: its strength is
// what the surface answers over range squared. Echoes within spot.merge_m of the nearest become one, at their mean by strength; the first
// that is strong enough is the range. So a beam across an edge reads in between two near surfaces and the nearer of two far ones, and dark
// or grazing surfaces read nothing. Retroreflectors read short (LaserSpot::retro_shift). Masked beams (spot.masked_deg) read nothing
// either. Ranges in metres without the product's error, 0 = nothing.
LaserScan spot_scan(const RayCaster& ray_caster, const Surfaces& surfaces, const LaserConfig& config, const std::string& sensor,
                    Stamp stamp, const std::function<Pose(Stamp)>& X_WL);

}  // namespace waretwin
