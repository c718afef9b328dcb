// A room seen by a 2D laser, by closed formulas: segments of straight wall, nothing else.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "mapper/localise/point_to_line.h"

namespace waretwin::test {

struct Wall {
  Eigen::Vector2d a, b;
};

inline void add_rectangle(std::vector<Wall>& walls, double x0, double y0, double x1, double y1) {
  walls.push_back({{x0, y0}, {x1, y0}});
  walls.push_back({{x1, y0}, {x1, y1}});
  walls.push_back({{x1, y1}, {x0, y1}});
  walls.push_back({{x0, y1}, {x0, y0}});
}

// 12 x 6 m with two boxes and a pillar.
inline std::vector<Wall> hall() {
  std::vector<Wall> walls;
  add_rectangle(walls, 0, 0, 12, 6);
  add_rectangle(walls, 3.0, 0.0, 3.8, 0.7);
  add_rectangle(walls, 7.0, 5.2, 8.2, 6.0);
  add_rectangle(walls, 9.5, 2.0, 9.9, 2.4);
  return walls;
}

// Distance from p along the heading to the nearest wall; infinity where there is none.
inline double cast(const std::vector<Wall>& walls, const Eigen::Vector2d& p, double heading) {
  const Eigen::Vector2d d(std::cos(heading), std::sin(heading));
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) {
    const Eigen::Vector2d e = wall.b - wall.a, o = wall.a - p;
    const double denominator = d.x() * e.y() - d.y() * e.x();
    if (std::abs(denominator) < 1e-12) continue;
    const double range = (o.x() * e.y() - o.y() * e.x()) / denominator;
    const double along = (o.x() * d.y() - o.y() * d.x()) / denominator;
    if (range > 0.0 && along >= 0.0 && along <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

// The error of one range. The S300's: sigma, then output in steps of 10 mm.
struct RangeError {
  double sigma = 0.0;
  double step = 0.0;
  double operator()(double range, const RandomStream& random, std::uint64_t beam) const {
    if (sigma > 0.0) range += sigma * random.normal(beam);
    if (step > 0.0) range = step * std::round(range / step);
    return range;
  }
};

// 541 beams over 270 deg, as points in the sensor's own frame.
inline std::vector<Eigen::Vector2d> scan_points(const std::vector<Wall>& walls, const PlanarMotion& X_WS, const RangeError& error = {},
                                                std::uint64_t seed = 0) {
  const RandomStream random(seed, "laser", "range");
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 541; ++i) {
    const double angle = (-135.0 + 0.5 * i) * std::numbers::pi / 180.0;
    const double range = error(cast(walls, X_WS.translation, X_WS.yaw + angle), random, i);
    if (std::isfinite(range) && range > 0.0) points.emplace_back(range * std::cos(angle), range * std::sin(angle));
  }
  return points;
}

}  // namespace waretwin::test
