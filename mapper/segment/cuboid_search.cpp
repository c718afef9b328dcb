#include "mapper/segment/cuboid_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace waretwin {
namespace {

using Points2 = std::vector<Eigen::Vector2d>;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Andrew's monotone chain; points on the hull's edges are dropped.
Points2 convex_hull(Points2 points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Points2 hull;
  const auto add_chain = [&hull](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0.0) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // the first point of the other chain
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

}  // namespace

Cuboid search_cuboid(const std::vector<Eigen::Vector3f>& points_W, double step_rad) {
  if (points_W.empty()) throw Error("a cuboid needs at least one point");
  if (!(step_rad > 0.0) || step_rad > std::numbers::pi) {
    throw Error("heading step " + std::to_string(step_rad) + " rad; expected more than 0 and at most pi");
  }
  Points2 points;
  points.reserve(points_W.size());
  double z_min = std::numeric_limits<double>::infinity();
  double z_max = -z_min;
  for (const Eigen::Vector3f& p_W : points_W) {
    points.emplace_back(p_W.x(), p_W.y());
    z_min = std::min<double>(z_min, p_W.z());
    z_max = std::max<double>(z_max, p_W.z());
  }
  const Points2 hull = convex_hull(std::move(points));

  Cuboid best;
  double best_area = std::numeric_limits<double>::infinity();
  const int headings = static_cast<int>(std::ceil(std::numbers::pi / step_rad - 1e-9));
  for (int i = 0; i < headings; ++i) {
    const double yaw = i * step_rad;
    const Eigen::Vector2d along(std::cos(yaw), std::sin(yaw));
    const Eigen::Vector2d across(-along.y(), along.x());
    double low_x = std::numeric_limits<double>::infinity(), high_x = -low_x, low_y = low_x, high_y = -low_x;
    for (const Eigen::Vector2d& p : hull) {
      const double x = p.dot(along), y = p.dot(across);
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
    }
    const double area = (high_x - low_x) * (high_y - low_y);
    if (area >= best_area) continue;
    best_area = area;
    const Eigen::Vector2d centre = 0.5 * (low_x + high_x) * along + 0.5 * (low_y + high_y) * across;
    best.centre = {centre.x(), centre.y(), 0.5 * (z_min + z_max)};
    best.size = {high_x - low_x, high_y - low_y, z_max - z_min};
    best.yaw = yaw;
  }
  best.frame = "world";
  return canonical(best);
}

}  // namespace waretwin
