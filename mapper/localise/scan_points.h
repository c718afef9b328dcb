// A scan as points in the plane, each with the direction of the surface that it lies on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/localise/local_map_config.h"
#include "mapper/localise/point_to_line.h"
#include "sensors/measurements.h"

namespace waretwin {

struct ScanPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();          // metres
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // unit, from the laser to the point: a range error moves the point along it
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();     // unit, of the surface, on the laser's side
};

// The points of a scan in the base's frame B at the middle of the turn. `to_first` and `to_last` are the motion of the base from there to
// the first and the last beam: X_B(middle)B(first), X_B(middle)B(last); in between the velocity is as good as constant.
// Points at the edge of a surface are left out, for their beam may have met both sides of it, and so are those whose neighbourhood is no
// line. What is left is in the order of the beams.
std::vector<ScanPoint> scan_points(const LaserScan& scan, const Pose& X_BL, const PlanarMotion& to_first, const PlanarMotion& to_last,
                                   const ScanPointsConfig& config);

}  // namespace waretwin
