// What a 2D laser scanner measures, without error.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/laser_config.h"
#include "sensors/measurements.h"
#include "sim/ray_caster.h"

namespace waretwin {

// A scan of the scanner's geometry that has seen nothing yet.
LaserScan empty_scan(const LaserConfig& config, const std::string& sensor, Stamp stamp);

// One turn that starts at `stamp`. Each beam leaves from where the laser is when the mirror points at it: X_WL gives the laser's pose at
// any time. Ranges are exact, 0 where nothing lies between the scanner's limits.
LaserScan ideal_scan(const RayCaster& ray_caster, const LaserConfig& config, const std::string& sensor, Stamp stamp,
                     const std::function<Pose(Stamp)>& X_WL);

}  // namespace waretwin
