#include "mapper/localise/point_to_line.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/pose.h"

namespace waretwin {
namespace {

// Minimum of r^T A r + 2 b . r over |r| = 1, A symmetric. Stationary points solve (A + m I) r = -b; the largest multiplier m with |r| = 1
// is the global minimum (More and Sorensen 1983).
Eigen::Vector2d minimise_on_circle(const Eigen::Matrix2d& A, const Eigen::Vector2d& b, const Eigen::Vector2d& fallback) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A);
  const Eigen::Vector2d& a = eigen.eigenvalues();  // ascending
  const Eigen::Vector2d c = eigen.eigenvectors().transpose() * b;
  const double length = c.norm();
  if (length == 0.0 && a[0] == a[1]) return fallback;
  const double smallest = std::max(1e-15 * (std::abs(a[0]) + std::abs(a[1]) + length), 1e-300);
  // |r|^2 falls from infinity to 0 as m runs from -a[0] to infinity; at m = |b| - a[0] it is at most 1.
  const auto squared_norm = [&](double m) { return c[0] * c[0] / ((a[0] + m) * (a[0] + m)) + c[1] * c[1] / ((a[1] + m) * (a[1] + m)); };
  double low = -a[0] + smallest;
  double high = -a[0] + std::max(length, 2.0 * smallest);
  Eigen::Vector2d in_eigenbasis;
  if (squared_norm(low) <= 1.0) {
    // Hard case: b has no part along the flattest direction; that direction fills what is missing to length 1.
    in_eigenbasis[1] = -c[1] / (a[1] - a[0] + smallest);
    in_eigenbasis[1] = std::clamp(in_eigenbasis[1], -1.0, 1.0);
    in_eigenbasis[0] = std::sqrt(std::max(0.0, 1.0 - in_eigenbasis[1] * in_eigenbasis[1]));
    const Eigen::Vector2d one = eigen.eigenvectors() * in_eigenbasis;
    const Eigen::Vector2d other = eigen.eigenvectors() * Eigen::Vector2d(-in_eigenbasis[0], in_eigenbasis[1]);
    return one.dot(fallback) >= other.dot(fallback) ? one : other;
  }
  for (int i = 0; i < 200 && high - low > 1e-16 * (std::abs(high) + std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (squared_norm(middle) > 1.0 ? low : high) = middle;
  }
  const double m = 0.5 * (low + high);
  in_eigenbasis = {-c[0] / (a[0] + m), -c[1] / (a[1] + m)};
  return (eigen.eigenvectors() * in_eigenbasis).normalized();
}

}  // namespace

Eigen::Matrix2d PlanarMotion::rotation() const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  return R;
}

PlanarMotion PlanarMotion::operator*(const PlanarMotion& other) const {
  return {rotation() * other.translation + translation, wrap_angle(yaw + other.yaw)};
}

PlanarMotion PlanarMotion::inverse() const { return {-(rotation().transpose() * translation), wrap_angle(-yaw)}; }

PointToLineSolution solve_point_to_line(const std::vector<PointOnLine>& pairs, const PlanarMotion& guess, double prior_weight) {
  WARETWIN_CHECK(!pairs.empty(), "a motion needs at least one pair");
  // Residual i is n.t + w.r - d with w = (n.p, n.Jp), J turning by 90 deg, and d = n.q.
  Eigen::Matrix2d N = Eigen::Matrix2d::Zero(), C = Eigen::Matrix2d::Zero(), Wm = Eigen::Matrix2d::Zero();
  Eigen::Vector2d e = Eigen::Vector2d::Zero(), f = Eigen::Vector2d::Zero();
  for (const PointOnLine& pair : pairs) {
    const Eigen::Vector2d& n = pair.normal;
    const Eigen::Vector2d w(n.dot(pair.point), -n.x() * pair.point.y() + n.y() * pair.point.x());
    const double d = n.dot(pair.on_line);
    N += n * n.transpose();
    C += n * w.transpose();
    Wm += w * w.transpose();
    e += d * n;
    f += d * w;
  }
  const double count = static_cast<double>(pairs.size());
  PointToLineSolution solution;
  solution.translation_information = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(N).eigenvalues()[0] / count;

  const double prior = prior_weight * count;
  const Eigen::Vector2d r_guess(std::cos(guess.yaw), std::sin(guess.yaw));
  N += prior * Eigen::Matrix2d::Identity();
  Wm += prior * Eigen::Matrix2d::Identity();
  e += prior * guess.translation;
  f += prior * r_guess;
  // For a given r the best t is N^-1 (e - C r); what is left is quadratic in r alone.
  const Eigen::Matrix2d N_inverse = N.inverse();
  Eigen::Matrix2d A = Wm - C.transpose() * N_inverse * C;
  A = (0.5 * (A + A.transpose())).eval();
  const Eigen::Vector2d b = C.transpose() * N_inverse * e - f;
  const Eigen::Vector2d r = minimise_on_circle(A, b, r_guess);
  solution.motion.yaw = std::atan2(r.y(), r.x());
  solution.motion.translation = N_inverse * (e - C * r);
  return solution;
}

}  // namespace waretwin
