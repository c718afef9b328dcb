#include "sensors/lens.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace waretwin {

bool Distortion::is_none() const {
  return k1 == 0.0 && k2 == 0.0 && k3 == 0.0 && k4 == 0.0 && k5 == 0.0 && k6 == 0.0 && p1 == 0.0 && p2 == 0.0;
}

Eigen::Vector2d Distortion::apply(const Eigen::Vector2d& xy) const {
  const double x = xy.x(), y = xy.y(), r2 = xy.squaredNorm();
  const double s = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {s * x + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), s * y + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Eigen::Matrix2d Distortion::slope(const Eigen::Vector2d& xy) const {
  const double x = xy.x(), y = xy.y(), r2 = xy.squaredNorm();
  const double above = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3)), below = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
  const double s = above / below;
  // By r^2, twice: the gradient of r^2 is 2 (x, y).
  const double ds = 2.0 * ((k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3)) - s * (k4 + r2 * (2.0 * k5 + 3.0 * r2 * k6))) / below;
  const double across = ds * x * y + 2.0 * p1 * x + 2.0 * p2 * y;
  Eigen::Matrix2d slope;
  slope << s + ds * x * x + 2.0 * p1 * y + 6.0 * p2 * x, across, across, s + ds * y * y + 6.0 * p1 * y + 2.0 * p2 * x;
  return slope;
}

void Distortion::visit(Fields& f) {
  const FieldRule rule = {.min = -100, .max = 100};
  f("k1", k1, "radial distortion, numerator, r^2", rule);
  f("k2", k2, "radial distortion, numerator, r^4", rule);
  f("k3", k3, "radial distortion, numerator, r^6", rule);
  f("k4", k4, "radial distortion, denominator, r^2", rule);
  f("k5", k5, "radial distortion, denominator, r^4", rule);
  f("k6", k6, "radial distortion, denominator, r^6", rule);
  f("p1", p1, "tangential distortion", rule);
  f("p2", p2, "tangential distortion", rule);
}

Lens::Lens(const Intrinsics& intrinsics, const Distortion& distortion)
    : intrinsics_(intrinsics), distortion_(distortion), largest_r2_(std::numeric_limits<double>::infinity()) {
  if (distortion.is_none()) return;
  // Up to 80 deg from the axis; the radial part decides.
  constexpr double kLargestRadius = 5.67, kStep = 0.01;
  Distortion radial = distortion;
  radial.p1 = radial.p2 = 0.0;
  double before = 0.0;
  for (double r = kStep; r <= kLargestRadius; r += kStep) {
    const double now = radial.apply({r, 0.0}).x();
    if (!(now > before)) {
      largest_r2_ = (r - kStep) * (r - kStep);
      return;
    }
    before = now;
  }
  largest_r2_ = kLargestRadius * kLargestRadius;
}

std::optional<Eigen::Vector3d> Lens::ray(double u, double v) const {
  const Eigen::Vector3d straight = intrinsics_.ray(u, v);
  if (distortion_.is_none()) return straight;
  const Eigen::Vector2d wanted = straight.head<2>();
  // Newton's method; converges in four or five steps where a ray exists.
  Eigen::Vector2d xy = wanted;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d miss = distortion_.apply(xy) - wanted;
    const Eigen::Vector2d step = distortion_.slope(xy).inverse() * miss;
    if (!step.allFinite()) return std::nullopt;
    // A step beyond the point's own distance from the axis would leave the branch that holds the image.
    const double longest = 0.5 + 0.5 * xy.norm();
    xy -= step.norm() > longest ? Eigen::Vector2d(step * (longest / step.norm())) : step;
    if (step.squaredNorm() < 1e-24) break;
  }
  if (!((distortion_.apply(xy) - wanted).squaredNorm() < 1e-18) || xy.squaredNorm() > largest_r2_) return std::nullopt;
  return Eigen::Vector3d(xy.x(), xy.y(), 1.0);
}

std::optional<Eigen::Vector2d> Lens::project(const Eigen::Vector3d& p_C) const {
  if (!(p_C.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d xy = p_C.head<2>() / p_C.z();
  if (xy.squaredNorm() > largest_r2_) return std::nullopt;
  const Eigen::Vector2d bent = distortion_.apply(xy);
  return Eigen::Vector2d(intrinsics_.fx * bent.x() + intrinsics_.cx, intrinsics_.fy * bent.y() + intrinsics_.cy);
}

}  // namespace waretwin
