// The rigid motion in the plane that brings points onto lines best: Censi's metric, solved exactly.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace waretwin {

// A planar rigid motion: q = R(yaw) p + translation.
struct PlanarMotion {
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();  // metres
  double yaw = 0.0;                                       // radians

  Eigen::Matrix2d rotation() const;
  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const { return rotation() * p + translation; }
  PlanarMotion operator*(const PlanarMotion& other) const;
  PlanarMotion inverse() const;
};

// "point should lie on the line through `on_line` with unit normal `normal`".
struct PointOnLine {
  Eigen::Vector2d point;
  Eigen::Vector2d on_line;
  Eigen::Vector2d normal;
};

struct PointToLineSolution {
  PlanarMotion motion;
  // How well the translation is determined: smallest eigenvalue of the mean of normal * normal^T, in [0, 0.5]; near 0 in a corridor.
  double translation_information = 0.0;
};

// Minimises sum_i (n_i . (R p_i + t - q_i))^2 over all rotations and translations, plus prior_weight * count * (|t - t_0|^2 + |r - r_0|^2)
// with r = (cos yaw, sin yaw), which holds directions that no line tells about at the guess. Source: Censi, "An ICP variant using a
// point-to-line metric", ICRA 2008, section III: a quadratic form in (t_x, t_y, cos, sin) under cos^2 + sin^2 = 1. Here t is eliminated
// first, so that the Lagrange multiplier is the largest root of a secular equation in one unknown, which gives the global minimum.
PointToLineSolution solve_point_to_line(const std::vector<PointOnLine>& pairs, const PlanarMotion& guess, double prior_weight);

}  // namespace waretwin
