// Where a conveyor carries: its running surface and what stands beside it, read from its triangles with rays from above.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scenes/motion_config.h"
#include "sim/ray_caster.h"

namespace waretwin {

// A strip along a straight centre line or along an arc, level. `along` runs in the belt's direction (an arc's: counter-clockwise) from the
// strip's beginning, in metres of the centre line; `side` is to the left of it (an arc's: towards its pivot).
struct BeltSurface {
  std::string name;                            // of the object
  int object = -1;                             // index into Scene::objects
  double top = 0.0;                            // height of the running surface in the world; of rollers, their crests
  double length = 0.0;                         // of the centre line
  double left = 0.0, right = 0.0;              // the running surface reaches from `right` (negative) to `left`
  double left_guard = 0.0, right_guard = 0.0;  // how far what stands there rises above it; 0 = nothing does

  bool curve = false;
  Eigen::Vector2d begin = Eigen::Vector2d::Zero();       // straight: start of the centre line, p_W
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // straight: unit
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();       // arc
  double radius = 0.0, first_angle = 0.0;                // arc: of the centre line, and where it begins, radians

  // The point of the strip at (along, side), and the direction of travel there.
  Eigen::Vector2d point(double along, double side) const;
  Eigen::Vector2d travel(const Eigen::Vector2d& p_W) const;
  // (along, side) of a point. Beyond an arc's ends `along` is below 0 or above the length, whichever end is nearer.
  Eigen::Vector2d coordinates(const Eigen::Vector2d& p_W) const;
  // Surface speed at `side` by that of the centre line: 1 on a straight belt, radius at the point over radius of the centre line on an arc.
  double speed_factor(const Eigen::Vector2d& p_W) const;
  bool carries(const Eigen::Vector2d& p_W) const;  // whether a point lies above the strip
};

// The running surfaces of all objects that the configuration names. Throws Error when it names none ("motion.belts.I.object ..."), and for
// an object without anything level to run on.
std::vector<BeltSurface> find_belt_surfaces(const RayCaster& ray_caster, const BeltConfig& config, std::size_t index);

}  // namespace waretwin
