// What a thing fills, as an upright box: enough to keep things apart, vehicles clear and lines of sight free.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "scenes/builder/model.h"

namespace waretwin::generate {

struct Solid {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // metres, on the floor
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  double yaw = 0.0;              // radians
  double low = 0.0, high = 0.0;  // metres above the floor
};

// A part whose box in its own frame is `extent`, placed.
Solid solid_of(const Eigen::AlignedBox3d& extent, const builder::Placement& at);

// From a point on the floor to the footprint; 0 inside.
double distance(const Eigen::Vector2d& p, const Solid& solid);

// The lower bound of the gap between two footprints that separating axes give: exact where an edge faces the other, else at most 30 % less.
// Negative where they overlap.
double gap(const Solid& a, const Solid& b);

// Nearer than `margin` on the floor plan, and at some common height.
bool collide(const Solid& a, const Solid& b, double margin);

// Whether the straight line between two points passes through the solid.
bool blocks(const Solid& solid, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// Where a placement in a parent's frame stands in the world.
builder::Placement placed(const builder::Placement& parent, const builder::Placement& child);

}  // namespace waretwin::generate
