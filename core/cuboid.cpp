#include "core/cuboid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace waretwin {

namespace {

using Polygon = std::vector<Eigen::Vector2d>;

// The part of a convex polygon with sign * p[axis] <= limit (one step of Sutherland-Hodgman).
Polygon clipped(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double excess_p = sign * p[axis] - limit;
    const double excess_q = sign * q[axis] - limit;
    if (excess_p <= 0) out.push_back(p);
    if ((excess_p < 0 && excess_q > 0) || (excess_p > 0 && excess_q < 0)) {
      out.push_back(p + (q - p) * (excess_p / (excess_p - excess_q)));
    }
  }
  return out;
}

double area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - polygon[0];
    const Eigen::Vector2d b = polygon[i + 1] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

Eigen::Vector2d rotated(const Eigen::Vector2d& p, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
}

// Area shared by the two footprints, in a's own axes, where a is an axis-aligned rectangle around the origin.
double footprint_overlap(const Cuboid& a, const Cuboid& b) {
  const Eigen::Vector2d centre = rotated(b.centre.head<2>() - a.centre.head<2>(), -a.yaw);
  Polygon polygon;
  for (const auto& corner : {Eigen::Vector2d(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
    polygon.push_back(centre + rotated(corner.cwiseProduct(b.size.head<2>()), b.yaw - a.yaw));
  }
  for (int axis = 0; axis < 2; ++axis) {
    polygon = clipped(polygon, axis, 1.0, 0.5 * a.size[axis]);
    polygon = clipped(polygon, axis, -1.0, 0.5 * a.size[axis]);
  }
  return area(polygon);
}

double cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

// Andrew's monotone chain: the corners of the hull counter-clockwise, without points on its edges.
Polygon convex_hull(Polygon points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Polygon hull(2 * points.size());
  std::size_t count = 0;
  const auto add = [&](const Eigen::Vector2d& p, std::size_t fixed) {
    while (count >= fixed + 2 && cross(hull[count - 2], hull[count - 1], p) <= 0) --count;
    hull[count++] = p;
  };
  for (const Eigen::Vector2d& p : points) add(p, 0);
  const std::size_t fixed = count - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], fixed);
  hull.resize(count - 1);
  return hull;
}

struct Rectangle {
  double yaw = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
};

// The smallest rectangle around a convex polygon shares a side with it (Freeman and Shapira 1975). While the edge turns once around,
// the farthest corners along it, across it and against it only move forward (Toussaint's rotating calipers).
Rectangle smallest_rectangle(const Polygon& hull) {
  const std::size_t n = hull.size();
  if (n == 1) return {0.0, hull[0], Eigen::Vector2d::Zero()};
  Rectangle best;
  double best_area = std::numeric_limits<double>::infinity();
  std::array<std::size_t, 3> caliper = {1, 1, 1};  // along, across, against
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d along = (hull[(i + 1) % n] - hull[i]).normalized();
    const Eigen::Vector2d across(-along.y(), along.x());
    const std::array<Eigen::Vector2d, 3> directions = {along, across, -along};
    std::array<double, 3> reach{};
    for (std::size_t k = 0; k < 3; ++k) {
      // Each caliper lies at or after the one before it, seen counter-clockwise from the edge.
      caliper[k] = std::max(caliper[k], k == 0 ? i + 1 : caliper[k - 1]);
      while (caliper[k] < i + n && directions[k].dot(hull[(caliper[k] + 1) % n]) >= directions[k].dot(hull[caliper[k] % n])) ++caliper[k];
      reach[k] = directions[k].dot(hull[caliper[k] % n]);
    }
    const double base = across.dot(hull[i]);
    const Eigen::Vector2d size(reach[0] + reach[2], reach[1] - base);
    if (size.x() * size.y() < best_area) {
      best_area = size.x() * size.y();
      best.yaw = std::atan2(along.y(), along.x());
      best.centre = along * (0.5 * (reach[0] - reach[2])) + across * (0.5 * (reach[1] + base));
      best.size = size.cwiseMax(0.0);
    }
  }
  return best;
}

}  // namespace

Pose Cuboid::pose() const { return make_upright_pose(centre.x(), centre.y(), centre.z(), yaw); }

std::vector<Eigen::Vector3d> Cuboid::corners() const {
  const Pose X_AO = pose();
  std::vector<Eigen::Vector3d> out;
  for (int index = 0; index < 8; ++index) {
    const Eigen::Vector3d sign(index & 1 ? 0.5 : -0.5, index & 2 ? 0.5 : -0.5, index & 4 ? 0.5 : -0.5);
    out.push_back(X_AO * sign.cwiseProduct(size));
  }
  return out;
}

Cuboid canonical(const Cuboid& cuboid) {
  Cuboid out = cuboid;
  if (out.size.y() > out.size.x()) {
    std::swap(out.size.x(), out.size.y());
    out.yaw += 0.5 * std::numbers::pi;
  }
  out.yaw = std::fmod(out.yaw, std::numbers::pi);
  if (out.yaw < 0) out.yaw += std::numbers::pi;
  // A tiny negative yaw rounds up to pi itself; adding 0.0 turns a negative zero into a positive one.
  out.yaw = out.yaw >= std::numbers::pi ? 0.0 : out.yaw + 0.0;
  return out;
}

Cuboid transformed(const Cuboid& cuboid, const Pose& X_AB, const std::string& frame_A) {
  WARETWIN_CHECK(X_AB.linear()(2, 2) > 1.0 - 1e-6, "a cuboid stays upright only under an upright motion");
  Cuboid out = cuboid;
  out.centre = X_AB * cuboid.centre;
  out.yaw = wrap_angle(cuboid.yaw + yaw_of(X_AB));
  out.frame = frame_A;
  return out;
}

double intersection_volume(const Cuboid& a, const Cuboid& b) {
  const double height = std::min(a.top(), b.top()) - std::max(a.bottom(), b.bottom());
  if (!(height > 0.0)) return 0.0;
  return height * footprint_overlap(a, b);
}

double iou_3d(const Cuboid& a, const Cuboid& b) {
  if (a.frame != b.frame) throw Error("boxes in frames '" + a.frame + "' and '" + b.frame + "' cannot be compared; expected one frame");
  const double volume_a = a.volume();
  const double volume_b = b.volume();
  if (!(volume_a > 0.0) || !(volume_b > 0.0)) return 0.0;
  const double shared = intersection_volume(a, b);
  return std::clamp(shared / (volume_a + volume_b - shared), 0.0, 1.0);
}

Cuboid minimum_area_cuboid(const std::vector<Eigen::Vector3d>& points, const std::string& frame) {
  if (points.empty()) throw Error("no points; expected at least one to put a box around");
  // Around the first point, so that a hall far from its origin loses no digits.
  const Eigen::Vector3d& origin = points.front();
  Polygon footprint;
  footprint.reserve(points.size());
  double low = 0.0;
  double high = 0.0;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) throw Error("a point is not finite; expected finite coordinates");
    footprint.push_back((p - origin).head<2>());
    low = std::min(low, p.z() - origin.z());
    high = std::max(high, p.z() - origin.z());
  }
  const Rectangle rectangle = smallest_rectangle(convex_hull(std::move(footprint)));
  Cuboid box;
  box.centre = origin + Eigen::Vector3d(rectangle.centre.x(), rectangle.centre.y(), 0.5 * (low + high));
  box.yaw = rectangle.yaw;
  box.size = {rectangle.size.x(), rectangle.size.y(), high - low};
  box.frame = frame;
  return canonical(box);
}

}  // namespace waretwin
