// The object model of the paper (section 3.2): an upright box, roll = pitch = 0, that names the frame it is given in.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/pose.h"

namespace waretwin {

struct Cuboid {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // metres
  double yaw = 0.0;                                  // radians about the frame's z; a box looks the same after pi
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    // full edge lengths dx, dy, dz in metres, each >= 0
  std::string frame = "world";

  double volume() const { return size.prod(); }
  Pose pose() const;  // X_AO, A being `frame`
  double bottom() const { return centre.z() - 0.5 * size.z(); }
  double top() const { return centre.z() + 0.5 * size.z(); }
  std::vector<Eigen::Vector3d> corners() const;  // 8 corners: bit 0 of the index = +x, bit 1 = +y, bit 2 = +z
};

// The same box with dx >= dy and yaw in [0, pi): the form in which cuboids are written and compared.
Cuboid canonical(const Cuboid& cuboid);

// The box moved by an upright rigid motion X_AB; its frame becomes `frame_A`.
Cuboid transformed(const Cuboid& cuboid, const Pose& X_AB, const std::string& frame_A);

// Exact volume of the intersection of two upright boxes: polygon clipping in x-y times the overlap in z. Both in one frame.
double intersection_volume(const Cuboid& a, const Cuboid& b);

// Exact 3D intersection over union in [0, 1]; 0 where either box is empty. Throws Error when the frames differ.
double iou_3d(const Cuboid& a, const Cuboid& b);

// The upright box of smallest x-y area around points (N x 3 in metres, any order), exact by rotating calipers over the convex hull;
// z from the lowest to the highest point. This defines the truth; the mapper has its own search (mapper/segment). Canonical.
// Throws Error when there are no points.
Cuboid minimum_area_cuboid(const std::vector<Eigen::Vector3d>& points, const std::string& frame = "world");

}  // namespace waretwin
