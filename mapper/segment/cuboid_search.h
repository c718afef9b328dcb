// Cuboid generation (section 3.2, step 3 and Fig. 3): rectangles of all sampled headings around the points seen from above, of which
// the smallest wins.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/cuboid.h"

namespace waretwin {

// Upright box around points_W (metres, any order): headings 0, step, 2 step ... below 180 deg are tried, the first of the smallest area is
// taken; z from the lowest to the highest point. Canonical form, frame "world". Only the convex hull is rotated, which gives the same
// rectangles as rotating all points. Throws Error when there are no points or the step is not in (0, pi].
Cuboid search_cuboid(const std::vector<Eigen::Vector3f>& points_W, double step_rad);

}  // namespace waretwin
