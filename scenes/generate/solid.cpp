#include "scenes/generate/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/pose.h"

namespace waretwin::generate {

namespace {

Eigen::Vector2d axis_of(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

}  // namespace

Solid solid_of(const Eigen::AlignedBox3d& extent, const builder::Placement& at) {
  const double yaw = to_radians(at.yaw_deg);
  const Eigen::Vector2d middle = Eigen::Rotation2Dd(yaw) * extent.center().head<2>();
  return {middle + Eigen::Vector2d(at.x, at.y), 0.5 * extent.sizes().head<2>(), yaw, at.z + extent.min().z(), at.z + extent.max().z()};
}

double distance(const Eigen::Vector2d& p, const Solid& solid) {
  const Eigen::Vector2d local = Eigen::Rotation2Dd(-solid.yaw) * (p - solid.centre);
  return (local.cwiseAbs() - solid.half).cwiseMax(0.0).norm();
}

double gap(const Solid& a, const Solid& b) {
  const Eigen::Vector2d between = b.centre - a.centre;
  double widest = -std::numeric_limits<double>::infinity();
  for (const double yaw : {a.yaw, a.yaw + std::numbers::pi / 2, b.yaw, b.yaw + std::numbers::pi / 2}) {
    const Eigen::Vector2d axis = axis_of(yaw);
    const auto reach = [&](const Solid& s) {
      return s.half.x() * std::abs(axis.dot(axis_of(s.yaw))) + s.half.y() * std::abs(axis.dot(axis_of(s.yaw + std::numbers::pi / 2)));
    };
    widest = std::max(widest, std::abs(axis.dot(between)) - reach(a) - reach(b));
  }
  return widest;
}

bool collide(const Solid& a, const Solid& b, double margin) {
  constexpr double kTouching = 1e-4;  // what stands on something does not collide with it
  if (std::min(a.high, b.high) - std::max(a.low, b.low) < kTouching) return false;
  return gap(a, b) < margin;
}

bool blocks(const Solid& solid, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Rotation2Dd turn(-solid.yaw);
  Eigen::Vector3d a, b;
  a << turn * (from.head<2>() - solid.centre), from.z();
  b << turn * (to.head<2>() - solid.centre), to.z();
  const Eigen::Vector3d low(-solid.half.x(), -solid.half.y(), solid.low), high(solid.half.x(), solid.half.y(), solid.high);
  double enter = 0.0, leave = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double step = b[k] - a[k];
    if (std::abs(step) < 1e-12) {
      if (a[k] < low[k] || a[k] > high[k]) return false;
      continue;
    }
    const double t0 = (low[k] - a[k]) / step, t1 = (high[k] - a[k]) / step;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter < leave;
}

builder::Placement placed(const builder::Placement& parent, const builder::Placement& child) {
  const Eigen::Vector2d moved = Eigen::Rotation2Dd(to_radians(parent.yaw_deg)) * Eigen::Vector2d(child.x, child.y);
  return {parent.x + moved.x(), parent.y + moved.y(), parent.z + child.z, parent.yaw_deg + child.yaw_deg};
}

}  // namespace waretwin::generate
