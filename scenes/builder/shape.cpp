#include "scenes/builder/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/pose.h"

namespace waretwin::builder {
namespace {

constexpr double kPi = std::numbers::pi;
const double kSmoothCosine = std::cos(to_radians(30.0));

std::uint32_t add_vertex(Shape& s, const Vector3d& p, const Vector3d& n, const Vector2d& uv) {
  s.positions.push_back(p);
  s.normals.push_back(n);
  s.uv.push_back(uv);
  return static_cast<std::uint32_t>(s.positions.size() - 1);
}

void add_triangle(Shape& s, std::uint32_t a, std::uint32_t b, std::uint32_t c) { s.triangles.insert(s.triangles.end(), {a, b, c}); }

void add_quad(Shape& s, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  add_triangle(s, a, b, c);
  add_triangle(s, a, c, d);
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Ear clipping; the profiles here have a few dozen corners at most.
std::vector<std::array<std::size_t, 3>> triangulate(const Profile& polygon) {
  std::vector<std::size_t> left(polygon.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<std::array<std::size_t, 3>> triangles;
  while (left.size() > 3) {
    bool found = false;
    for (std::size_t i = 0; i < left.size() && !found; ++i) {
      const std::size_t a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
      const Vector2d &pa = polygon[a], &pb = polygon[b], &pc = polygon[c];
      if (cross(pb - pa, pc - pb) <= 1e-14) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](std::size_t k) {
        if (k == a || k == b || k == c) return false;
        const Vector2d& p = polygon[k];
        return cross(pb - pa, p - pa) >= 0 && cross(pc - pb, p - pb) >= 0 && cross(pa - pc, p - pc) >= 0;
      });
      if (!empty) continue;
      triangles.push_back({a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      found = true;
    }
    WARETWIN_CHECK(found, "a profile must be a simple polygon, counter-clockwise");
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

// The two outward normals at each corner of a polygon: that of the edge before and after it; averaged where the corner is smooth.
struct CornerNormals {
  Vector2d before, after;
};

std::vector<CornerNormals> corner_normals(const Profile& p, bool closed) {
  const std::size_t n = p.size();
  const auto edge_normal = [&](std::size_t i) {
    const Vector2d d = (p[(i + 1) % n] - p[i]).normalized();
    return Vector2d(d.y(), -d.x());
  };
  std::vector<CornerNormals> normals(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool first = i == 0 && !closed, last = i + 1 == n && !closed;
    const Vector2d before = first ? edge_normal(0) : edge_normal((i + n - 1) % n);
    const Vector2d after = last ? before : edge_normal(i);
    if (before.dot(after) >= kSmoothCosine) {
      const Vector2d mean = (before + after).normalized();
      normals[i] = {mean, mean};
    } else {
      normals[i] = {before, after};
    }
  }
  return normals;
}

}  // namespace

Shape& Shape::append(const Shape& other) {
  const auto offset = static_cast<std::uint32_t>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  uv.insert(uv.end(), other.uv.begin(), other.uv.end());
  for (const std::uint32_t index : other.triangles) triangles.push_back(index + offset);
  return *this;
}

Shape& Shape::move(double x, double y, double z) {
  for (Vector3d& p : positions) p += Vector3d(x, y, z);
  return *this;
}

Shape& Shape::rotate(const Vector3d& axis, double degrees) {
  return transform(Eigen::Isometry3d(Eigen::AngleAxisd(to_radians(degrees), axis.normalized())));
}

Shape& Shape::transform(const Eigen::Isometry3d& X) {
  for (Vector3d& p : positions) p = X * p;
  for (Vector3d& n : normals) n = X.linear() * n;
  return *this;
}

Shape box(double dx, double dy, double dz) { return bevelled_box(dx, dy, dz, 0.0); }

Shape bevelled_box(double dx, double dy, double dz, double bevel) {
  const Vector3d half(dx / 2, dy / 2, dz / 2);
  const double b = std::min(bevel, 0.49 * 2 * half.minCoeff());
  Shape s;
  // Corner c (bits: x, y, z) has one vertex on each of its three faces; id[c][axis] is the one on the face across that axis.
  std::array<std::array<std::uint32_t, 3>, 8> id{};
  for (std::size_t c = 0; c < 8; ++c) {
    const Vector3d sign((c & 1) ? 1 : -1, (c & 2) ? 1 : -1, (c & 4) ? 1 : -1);
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d p = sign.cwiseProduct(half);
      for (int other = 0; other < 3; ++other) {
        if (other != axis) p[other] -= sign[other] * b;
      }
      Vector3d n = Vector3d::Zero();
      n[axis] = sign[axis];
      // Upright faces: u around, v down; level faces: u along x, v against y.
      const Vector2d uv = axis == 0   ? Vector2d(sign[0] * p.y() + half.y(), half.z() - p.z())
                          : axis == 1 ? Vector2d(-sign[1] * p.x() + half.x(), half.z() - p.z())
                                      : Vector2d(p.x() + half.x(), half.y() - p.y());
      id[c][static_cast<std::size_t>(axis)] = add_vertex(s, p, n, uv);
    }
  }
  const auto outward_quad = [&](std::uint32_t a, std::uint32_t p, std::uint32_t q, std::uint32_t r) {
    const Vector3d normal = (s.positions[p] - s.positions[a]).cross(s.positions[r] - s.positions[a]);
    const Vector3d mean = s.normals[a] + s.normals[p] + s.normals[q] + s.normals[r];
    if (normal.dot(mean) >= 0) {
      add_quad(s, a, p, q, r);
    } else {
      add_quad(s, a, r, q, p);
    }
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t bit = std::size_t{1} << axis, u = std::size_t{1} << ((axis + 1) % 3), v = std::size_t{1} << ((axis + 2) % 3);
    for (const std::size_t side : {std::size_t{0}, bit}) {
      outward_quad(id[side][axis], id[side | u][axis], id[side | u | v][axis], id[side | v][axis]);
    }
    if (b <= 0) continue;
    // The four edges along this axis join the faces across the other two.
    const std::size_t face_u = (axis + 1) % 3, face_v = (axis + 2) % 3;
    for (const std::size_t edge : {std::size_t{0}, u, v, u | v}) {
      outward_quad(id[edge][face_u], id[edge | bit][face_u], id[edge | bit][face_v], id[edge][face_v]);
    }
  }
  if (b > 0) {
    for (const auto& corner : id) {
      const Vector3d normal = (s.positions[corner[1]] - s.positions[corner[0]]).cross(s.positions[corner[2]] - s.positions[corner[0]]);
      const Vector3d mean = s.normals[corner[0]] + s.normals[corner[1]] + s.normals[corner[2]];
      if (normal.dot(mean) >= 0) {
        add_triangle(s, corner[0], corner[1], corner[2]);
      } else {
        add_triangle(s, corner[0], corner[2], corner[1]);
      }
    }
  }
  return s;
}

Shape standing_box(double dx, double dy, double dz, double bevel) { return bevelled_box(dx, dy, dz, bevel).move(0, 0, dz / 2); }

Shape cylinder(const Vector3d& from, const Vector3d& to, double radius, int sides, bool caps) {
  const double length = (to - from).norm();
  Shape s = caps ? turned({{0, 0}, {radius, 0}, {radius, length}, {0, length}}, sides) : turned({{radius, 0}, {radius, length}}, sides);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to - from).toRotationMatrix();
  X.translation() = from;
  return s.transform(X);
}

Shape turned(const Profile& radius_z, int sides) {
  const std::vector<CornerNormals> normals = corner_normals(radius_z, false);
  Shape s;
  double along = 0;
  for (std::size_t i = 0; i + 1 < radius_z.size(); ++i) {
    const Vector2d a = radius_z[i], b = radius_z[i + 1];
    const double length = (b - a).norm(), mean_radius = std::max(a.x(), b.x());
    const bool level = std::abs(a.y() - b.y()) < 1e-9;
    std::uint32_t previous_a = 0, previous_b = 0;
    for (int k = 0; k <= sides; ++k) {
      const double angle = 2 * kPi * (k % sides) / sides, around = 2 * kPi * k / sides;
      const Vector3d out(std::cos(angle), std::sin(angle), 0);
      const auto point = [&](const Vector2d& rz) { return Vector3d(out * rz.x() + Vector3d(0, 0, rz.y())); };
      const auto normal = [&](const Vector2d& n) { return Vector3d(out * n.x() + Vector3d(0, 0, n.y())).normalized(); };
      const auto texture = [&](const Vector2d& rz, double v) {
        return level ? Vector2d(out.x() * rz.x(), -out.y() * rz.x()) : Vector2d(around * mean_radius, -v);
      };
      const std::uint32_t now_a = add_vertex(s, point(a), normal(normals[i].after), texture(a, along));
      const std::uint32_t now_b = add_vertex(s, point(b), normal(normals[i + 1].before), texture(b, along + length));
      if (k > 0) {
        if (a.x() > 0) add_triangle(s, previous_a, now_a, now_b);
        if (b.x() > 0) add_triangle(s, previous_a, now_b, previous_b);
      }
      previous_a = now_a;
      previous_b = now_b;
    }
    along += length;
  }
  return s;
}

Shape tube(const std::vector<Vector3d>& path, double radius, int sides) {
  Shape s;
  Vector3d direction = (path[1] - path[0]).normalized();
  Vector3d side = (std::abs(direction.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX()).cross(direction).normalized();
  double along = 0;
  std::uint32_t previous = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vector3d before = i > 0 ? (path[i] - path[i - 1]).normalized() : (path[1] - path[0]).normalized();
    const Vector3d after = i + 1 < path.size() ? (path[i + 1] - path[i]).normalized() : before;
    const Vector3d now = (before + after).normalized();
    side = (Eigen::Quaterniond::FromTwoVectors(direction, now) * side).normalized();
    direction = now;
    const Vector3d up = direction.cross(side);
    if (i > 0) along += (path[i] - path[i - 1]).norm();
    const auto first = static_cast<std::uint32_t>(s.positions.size());
    for (int k = 0; k <= sides; ++k) {
      const double angle = 2 * kPi * k / sides;
      const Vector3d out = std::cos(angle) * side + std::sin(angle) * up;
      add_vertex(s, path[i] + radius * out, out, {angle * radius, along});
    }
    if (i > 0) {
      for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides); ++k) {
        add_quad(s, previous + k, previous + k + 1, first + k + 1, first + k);
      }
    }
    previous = first;
  }
  const auto cap = [&](std::size_t at, const Vector3d& normal) {
    const auto first = static_cast<std::uint32_t>(at == 0 ? 0 : s.positions.size() - static_cast<std::size_t>(sides) - 1);
    std::vector<std::uint32_t> ring;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides); ++k) ring.push_back(first + k);
    const std::uint32_t centre = add_vertex(s, path[at], normal, {0, 0});
    std::vector<std::uint32_t> copies;
    for (const std::uint32_t k : ring) copies.push_back(add_vertex(s, s.positions[k], normal, {0, 0}));
    for (std::size_t k = 0; k < copies.size(); ++k) {
      const std::uint32_t a = copies[k], b = copies[(k + 1) % copies.size()];
      at == 0 ? add_triangle(s, centre, b, a) : add_triangle(s, centre, a, b);
    }
  };
  const Vector3d end = (path.back() - path[path.size() - 2]).normalized();
  cap(path.size() - 1, end);
  cap(0, -(path[1] - path[0]).normalized());
  return s;
}

std::vector<Vector3d> smooth_path(const std::vector<Vector3d>& p, int steps) {
  std::vector<Vector3d> path;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vector3d a = i > 0 ? p[i - 1] : Vector3d(2 * p[0] - p[1]), b = p[i], c = p[i + 1];
    const Vector3d d = i + 2 < p.size() ? p[i + 2] : Vector3d(2 * c - b);
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      path.push_back(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t * t * t));
    }
  }
  path.push_back(p.back());
  return path;
}

Shape extruded(const Profile& yz, double length) {
  const std::vector<CornerNormals> normals = corner_normals(yz, true);
  Shape s;
  double around = 0;
  for (std::size_t i = 0; i < yz.size(); ++i) {
    const std::size_t j = (i + 1) % yz.size();
    const double step = (yz[j] - yz[i]).norm();
    const auto vertex = [&](double x, std::size_t corner, const Vector2d& n, double v) {
      return add_vertex(s, {x, yz[corner].x(), yz[corner].y()}, {0, n.x(), n.y()}, {x, -v});
    };
    const double x0 = -length / 2, x1 = length / 2;
    const std::uint32_t a = vertex(x0, i, normals[i].after, around), b = vertex(x1, i, normals[i].after, around);
    const std::uint32_t c = vertex(x1, j, normals[j].before, around + step), d = vertex(x0, j, normals[j].before, around + step);
    add_quad(s, a, d, c, b);
    around += step;
  }
  const auto faces = triangulate(yz);
  for (const double sign : {1.0, -1.0}) {
    const auto first = static_cast<std::uint32_t>(s.positions.size());
    for (const Vector2d& p : yz) add_vertex(s, {sign * length / 2, p.x(), p.y()}, {sign, 0, 0}, {sign * p.x(), -p.y()});
    for (const auto& f : faces) {
      const auto a = first + static_cast<std::uint32_t>(f[0]), b = first + static_cast<std::uint32_t>(f[1]),
                 c = first + static_cast<std::uint32_t>(f[2]);
      sign > 0 ? add_triangle(s, a, b, c) : add_triangle(s, a, c, b);
    }
  }
  return s;
}

Shape swept(const Profile& radius_z, double degrees, int steps) {
  const std::vector<CornerNormals> normals = corner_normals(radius_z, true);
  const double total = to_radians(degrees);
  Shape s;
  const auto out = [&](int k) { return Vector3d(std::cos(total * k / steps), std::sin(total * k / steps), 0); };
  double around = 0;
  for (std::size_t i = 0; i < radius_z.size(); ++i) {
    const std::size_t j = (i + 1) % radius_z.size();
    const double step = (radius_z[j] - radius_z[i]).norm();
    const double mean_radius = 0.5 * (radius_z[i].x() + radius_z[j].x());
    const auto vertex = [&](int k, std::size_t corner, const Vector2d& n, double v) {
      const Vector3d o = out(k);
      return add_vertex(s, o * radius_z[corner].x() + Vector3d(0, 0, radius_z[corner].y()), o * n.x() + Vector3d(0, 0, n.y()),
                        {total * k / steps * mean_radius, -v});
    };
    std::uint32_t previous_a = 0, previous_b = 0;
    for (int k = 0; k <= steps; ++k) {
      const std::uint32_t a = vertex(k, i, normals[i].after, around), b = vertex(k, j, normals[j].before, around + step);
      if (k > 0) add_quad(s, previous_a, a, b, previous_b);
      previous_a = a;
      previous_b = b;
    }
    around += step;
  }
  const auto faces = triangulate(radius_z);
  for (const int k : {0, steps}) {
    const Vector3d o = out(k), along(-o.y(), o.x(), 0);
    const Vector3d normal = k == 0 ? Vector3d(-along) : along;
    const auto first = static_cast<std::uint32_t>(s.positions.size());
    for (const Vector2d& p : radius_z) add_vertex(s, o * p.x() + Vector3d(0, 0, p.y()), normal, {p.x(), -p.y()});
    for (const auto& f : faces) {
      const auto a = first + static_cast<std::uint32_t>(f[0]), b = first + static_cast<std::uint32_t>(f[1]),
                 c = first + static_cast<std::uint32_t>(f[2]);
      k == 0 ? add_triangle(s, a, b, c) : add_triangle(s, a, c, b);
    }
  }
  return s;
}

Shape flat_polygon(const Profile& xy) {
  Shape s;
  for (const Vector2d& p : xy) add_vertex(s, {p.x(), p.y(), 0}, Vector3d::UnitZ(), {p.x(), -p.y()});
  for (const auto& f : triangulate(xy)) {
    add_triangle(s, static_cast<std::uint32_t>(f[0]), static_cast<std::uint32_t>(f[1]), static_cast<std::uint32_t>(f[2]));
  }
  return s;
}

Shape rectangle(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v) {
  const Vector3d normal = edge_u.cross(edge_v).normalized();
  const double u = edge_u.norm(), v = edge_v.norm();
  Shape s;
  add_vertex(s, corner, normal, {0, v});
  add_vertex(s, corner + edge_u, normal, {u, v});
  add_vertex(s, corner + edge_u + edge_v, normal, {u, 0});
  add_vertex(s, corner + edge_v, normal, {0, 0});
  add_quad(s, 0, 1, 2, 3);
  return s;
}

Shape picture(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v) {
  Shape s = rectangle(corner, edge_u, edge_v);
  s.uv = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  return s;
}

Profile circle(double radius, int sides, const Vector2d& centre) {
  Profile p;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * kPi * k / sides;
    p.push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return p;
}

Profile rounded_rectangle(double width, double height, double radius, int steps) {
  Profile p;
  for (int corner = 0; corner < 4; ++corner) {
    const double sx = corner == 0 || corner == 3 ? 1 : -1, sy = corner < 2 ? 1 : -1;
    const Vector2d centre(sx * (width / 2 - radius), sy * (height / 2 - radius));
    for (int k = 0; k <= steps; ++k) {
      const double angle = kPi / 2 * (corner + static_cast<double>(k) / steps);
      p.push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  return p;
}

}  // namespace waretwin::builder
