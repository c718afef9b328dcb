// What stands where in a hall, triangle by triangle: for tests that nothing cuts into anything and that routes are clear.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/cuboid.h"
#include "core/pose.h"
#include "scenes/scenario.h"

namespace waretwin::test {

// An upright box that stands anywhere, for overlap with triangles.
struct Solid {
  Eigen::Vector3d centre, half;
  double yaw;
};

inline Solid solid_of(const Cuboid& c, double shrink_xy, double bottom, double top) {
  return {{c.centre.x(), c.centre.y(), 0.5 * (bottom + top)},
          {0.5 * c.size.x() - shrink_xy, 0.5 * c.size.y() - shrink_xy, 0.5 * (top - bottom)},
          c.yaw};
}

// Separating axes of a box and a triangle (Akenine-Moeller): three faces, the triangle's plane, nine products of edges.
inline bool overlaps(const Solid& s, const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& c_W) {
  const Eigen::AngleAxisd R_SW(-s.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d v[3] = {R_SW * (a_W - s.centre), R_SW * (b_W - s.centre), R_SW * (c_W - s.centre)};
  const auto separates = [&](const Eigen::Vector3d& axis) {
    if (axis.squaredNorm() < 1e-18) return false;
    const double p0 = axis.dot(v[0]), p1 = axis.dot(v[1]), p2 = axis.dot(v[2]);
    const double reach = s.half.dot(axis.cwiseAbs());
    return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
  };
  const Eigen::Vector3d edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  for (int k = 0; k < 3; ++k) {
    if (separates(Eigen::Vector3d::Unit(k))) return false;
  }
  if (separates(edges[0].cross(edges[1]))) return false;
  for (int k = 0; k < 3; ++k) {
    for (const Eigen::Vector3d& edge : edges) {
      if (separates(Eigen::Vector3d::Unit(k).cross(edge))) return false;
    }
  }
  return true;
}

// Names of the instances that reach into the solid and that `counts` takes.
template <class Counts>
std::set<std::string> things_in(const Scene& scene, const Solid& solid, const Counts& counts) {
  std::set<std::string> names;
  const double reach = solid.half.norm();
  for (const Instance& instance : scene.instances) {
    if (!counts(instance)) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p_M : mesh.positions) box.extend(instance.X_WM * p_M);
    const Eigen::Vector3d nearest = solid.centre.cwiseMax(box.min().cast<double>()).cwiseMin(box.max().cast<double>());
    if ((nearest - solid.centre).norm() > reach) continue;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const auto corner = [&](std::size_t k) {
        return Eigen::Vector3d((instance.X_WM * mesh.positions[mesh.triangles[t + k]]).cast<double>());
      };
      if (!overlaps(solid, corner(0), corner(1), corner(2))) continue;
      names.insert(instance.name);
      break;
    }
  }
  return names;
}

// Those outside any object; the floor's marks and the floor itself lie below 2 mm.
inline std::set<std::string> background_in(const Scene& scene, const Solid& solid) {
  return things_in(scene, solid, [](const Instance& instance) { return instance.object < 0; });
}

// Whether the segment from p to q passes through the triangle, by more than `depth` on both sides of its plane: what only touches, does
// not.
inline bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const std::array<Eigen::Vector3d, 3>& t, double depth) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  if (normal.norm() < 1e-12) return false;
  const double before = (p - t[0]).dot(normal) / normal.norm(), after = (q - t[0]).dot(normal) / normal.norm();
  if (std::min(before, after) > -depth || std::max(before, after) < depth) return false;
  const Eigen::Vector3d at = p + (q - p) * before / (before - after);
  for (std::size_t k = 0; k < 3; ++k) {
    // By more than the rounding of the files inside each edge.
    const Eigen::Vector3d edge = t[(k + 1) % 3] - t[k];
    if (edge.cross(at - t[k]).dot(normal) < 1e-4 * edge.norm() * normal.norm()) return false;
  }
  return true;
}

// Names of the instances whose triangles pass through those of an object (an index into the scene's), or its through theirs, by more than
// 1 mm.
inline std::set<std::string> cuts_into(const Scene& scene, int object) {
  using Triangle = std::array<Eigen::Vector3d, 3>;
  Eigen::AlignedBox3d reach;
  const auto triangles_of = [&](const Instance& instance, bool all) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    std::vector<Triangle> list;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      Triangle corners;
      Eigen::AlignedBox3d box;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = (instance.X_WM * mesh.positions[mesh.triangles[t + k]]).template cast<double>();
        box.extend(corners[k]);
      }
      if (all || reach.intersects(box)) list.push_back(corners);
    }
    return list;
  };
  const auto own = [&](const Instance& instance) { return instance.object == object; };
  std::vector<Triangle> mine;
  for (const Instance& instance : scene.instances) {
    if (!own(instance)) continue;
    for (const Triangle& t : triangles_of(instance, true)) mine.push_back(t);
  }
  for (const Triangle& t : mine) {
    for (const Eigen::Vector3d& p : t) reach.extend(p);
  }
  constexpr double kDepth = 0.001;
  std::set<std::string> names;
  for (const Instance& instance : scene.instances) {
    if (own(instance)) continue;
    const std::vector<Triangle> others = triangles_of(instance, false);
    const bool meet = std::any_of(others.begin(), others.end(), [&](const Triangle& other) {
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& p : other) box.extend(p);
      return std::any_of(mine.begin(), mine.end(), [&](const Triangle& t) {
        for (int axis = 0; axis < 3; ++axis) {
          if (std::min({t[0][axis], t[1][axis], t[2][axis]}) > box.max()[axis]) return false;
          if (std::max({t[0][axis], t[1][axis], t[2][axis]}) < box.min()[axis]) return false;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          if (pierces(t[k], t[(k + 1) % 3], other, kDepth) || pierces(other[k], other[(k + 1) % 3], t, kDepth)) return true;
        }
        return false;
      });
    });
    if (meet) names.insert(instance.name);
  }
  return names;
}

inline std::string joined(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + " ";
  return text;
}

// What the vehicle would touch: its body, `margin` wider on every side, at each turn in steps of 3 deg and along each straight piece.
inline std::set<std::string> on_the_route(const Scene& scene, const RobotConfig& robot, double margin) {
  const double low = 0.02, high = 1.45;  // from what wheels roll over up to the camera
  std::set<std::string> met;
  const auto check = [&](const Eigen::Vector2d& at, double length, double yaw) {
    const Solid body{{at.x(), at.y(), 0.5 * (low + high)}, {0.5 * length + margin, 0.5 * robot.width_m + margin, 0.5 * (high - low)}, yaw};
    for (const std::string& name : background_in(scene, body)) {
      met.insert(name + " at (" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ") yaw " + std::to_string(to_degrees(yaw)));
    }
    for (const TrueObject& object : scene.objects) {
      Cuboid box;
      box.centre = body.centre;
      box.size = 2 * body.half;
      box.yaw = yaw;
      if (intersection_volume(box, object.cuboid) > 0) met.insert(object.name);
    }
  };
  const auto turn = [&](const Eigen::Vector2d& at, double from, double to) {
    const double angle = wrap_angle(to - from);
    const int steps = 1 + static_cast<int>(std::abs(angle) / to_radians(3.0));
    for (int k = 1; k <= steps; ++k) check(at, robot.length_m, from + angle * k / steps);
  };
  Eigen::Vector2d at(robot.route[0].x_m, robot.route[0].y_m);
  double yaw = to_radians(robot.route[0].heading_deg.value_or(0.0));
  check(at, robot.length_m, yaw);
  for (std::size_t i = 1; i < robot.route.size(); ++i) {
    const Waypoint& next = robot.route[i];
    const Eigen::Vector2d to(next.x_m, next.y_m), way = to - at;
    const double heading = std::atan2(way.y(), way.x()) + (next.reverse ? std::numbers::pi : 0.0);
    turn(at, yaw, heading);
    check(0.5 * (at + to), robot.length_m + way.norm(), heading);
    yaw = heading;
    at = to;
    if (next.heading_deg) {
      turn(at, yaw, to_radians(*next.heading_deg));
      yaw = to_radians(*next.heading_deg);
    }
  }
  return met;
}

}  // namespace waretwin::test
