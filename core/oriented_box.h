// Boxes of any orientation, for metrics on other people's truth (Objectron, SceneNN), where roll and pitch are not 0.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/pose.h"

namespace waretwin {

struct OrientedBox {
  Pose X_AO = Pose::Identity();                    // centre and axes of the box in its frame A
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // full edge lengths in metres, each >= 0
};

// The box through 8 corners in the order in which bit 0 of the index runs along z, bit 1 along y and bit 2 along x.
// Throws Error when the corners do not span a right-angled box (relative tolerance 1e-3).
OrientedBox oriented_box_from_corners(const std::array<Eigen::Vector3d, 8>& corners);

// Exact volume of the intersection of two boxes: one box's faces are clipped by the other's half spaces (Sutherland-Hodgman in 3D) and
// the volume of the convex rest follows from the divergence theorem.
double intersection_volume(const OrientedBox& a, const OrientedBox& b);

// Exact 3D intersection over union in [0, 1]; 0 where either box is empty.
double iou_3d(const OrientedBox& a, const OrientedBox& b);

}  // namespace waretwin
