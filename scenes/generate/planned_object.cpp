#include "scenes/generate/planned_object.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"

namespace waretwin::generate {

namespace {

using builder::CurveConveyor;
using builder::FloorConveyor;
using builder::TableTopConveyor;
using Eigen::Vector3d;

constexpr double kPatch = 0.07;        // metres between patches
constexpr double kFrameHeight = 0.12;  // of floor-standing conveyors, as parts/conveyors.cpp builds them
constexpr double kPieceDeg = 20.0;     // of a curve that one box stands for

double rail_top(const FloorConveyor& c) { return c.height + (c.rollers ? 0.02 : 0.01); }
double rail_top(const CurveConveyor& c) { return c.height + (c.belt ? 0.01 : 0.02); }

// Patches over a rectangle about `middle`.
void add_face(std::vector<SurfacePatch>& out, const Vector3d& middle, const Vector3d& edge_u, const Vector3d& edge_v) {
  const int nu = std::max(1, static_cast<int>(std::lround(edge_u.norm() / kPatch)));
  const int nv = std::max(1, static_cast<int>(std::lround(edge_v.norm() / kPatch)));
  const Vector3d normal = edge_u.cross(edge_v).normalized();
  for (int i = 0; i < nu; ++i) {
    for (int k = 0; k < nv; ++k) {
      const Vector3d p = middle + ((i + 0.5) / nu - 0.5) * edge_u + ((k + 0.5) / nv - 0.5) * edge_v;
      out.push_back({p, normal, edge_u.norm() * edge_v.norm() / (nu * nv)});
    }
  }
}

// Rollers show what slants to either side of their top to cameras before and behind: patches whose normals lean along x (or along the
// curve). `p` is a copy: it may be that of a patch in `patches`, which move when they grow.
void add_roller_flanks(std::vector<SurfacePatch>& patches, const Vector3d p, const Vector3d& along, double area) {
  for (const double side : {-1.0, 1.0}) {
    patches.push_back({p, (0.9 * side * along + 0.44 * Vector3d::UnitZ()).normalized(), 0.35 * area});
  }
}

// The same over a rectangle that lies level.
void add_roller_flanks(std::vector<SurfacePatch>& patches, double length, double width, double top) {
  std::vector<SurfacePatch> deck;
  add_face(deck, {0, 0, top}, {length, 0, 0}, {0, width, 0});
  for (const SurfacePatch& patch : deck) add_roller_flanks(patches, patch.p_W, Vector3d::UnitX(), patch.area);
}

// Top and four sides of an upright box about (x, y), turned by `yaw`.
void add_box(std::vector<SurfacePatch>& out, const Eigen::Vector2d& at, double dx, double dy, double low, double high, double yaw,
             bool top) {
  const Eigen::AngleAxisd R(yaw, Vector3d::UnitZ());
  const Vector3d foot(at.x(), at.y(), 0), x = R * Vector3d(dx, 0, 0), y = R * Vector3d(0, dy, 0), z(0, 0, high - low);
  const Vector3d middle = foot + Vector3d(0, 0, 0.5 * (low + high));
  if (top) add_face(out, foot + Vector3d(0, 0, high), x, y);
  add_face(out, middle - 0.5 * y, x, z);
  add_face(out, middle + 0.5 * y, -x, z);
  add_face(out, middle + 0.5 * x, y, z);
  add_face(out, middle - 0.5 * x, -y, z);
}

std::vector<SurfacePatch> local_surface(const TableTopConveyor& c) {
  std::vector<SurfacePatch> patches;
  add_box(patches, {0, 0}, c.length, c.width, 0, c.height, 0, true);
  if (c.rollers) add_roller_flanks(patches, c.length, c.width, c.height);
  return patches;
}

std::vector<SurfacePatch> local_surface(const FloorConveyor& c) {
  std::vector<SurfacePatch> patches;
  const double top = rail_top(c);
  add_box(patches, {0, 0}, c.length, c.width, top - kFrameHeight, top, 0, true);
  if (c.rollers) add_roller_flanks(patches, c.length, c.width, top);
  const int pairs = std::max(2, static_cast<int>(std::ceil(c.length / 2.0)) + 1);
  for (int i = 0; i < pairs; ++i) {
    for (const double side : {-1.0, 1.0}) {
      add_box(patches, {(c.length - 0.3) * (i / (pairs - 1.0) - 0.5), side * (c.width / 2 - 0.05)}, 0.05, 0.04, 0, top - 0.2, 0, false);
    }
  }
  return patches;
}

std::vector<SurfacePatch> local_surface(const CurveConveyor& c) {
  std::vector<SurfacePatch> patches;
  const double top = rail_top(c), total = to_radians(c.degrees);
  const double inside = c.radius - c.width / 2, outside = c.radius + c.width / 2;
  const auto out = [](double a) { return Vector3d(std::cos(a), std::sin(a), 0); };
  const int steps = std::max(2, static_cast<int>(std::lround(total * c.radius / kPatch)));
  const int rings = std::max(2, static_cast<int>(std::lround(c.width / kPatch)));
  for (int i = 0; i < steps; ++i) {
    const double a = (i + 0.5) / steps * total, arc = total / steps;
    for (int k = 0; k < rings; ++k) {
      const double r = inside + (k + 0.5) / rings * c.width;
      const double area = r * arc * c.width / rings;
      patches.push_back({out(a) * r + Vector3d(0, 0, top), Vector3d::UnitZ(), area});
      if (!c.belt) add_roller_flanks(patches, patches.back().p_W, Vector3d(-out(a).y(), out(a).x(), 0), area);
    }
    const Vector3d z(0, 0, top - 0.5 * kFrameHeight);
    patches.push_back({out(a) * outside + z, out(a), outside * arc * kFrameHeight});
    patches.push_back({out(a) * inside + z, -out(a), inside * arc * kFrameHeight});
  }
  for (const double share : {0.08, 0.5, 0.92}) {
    for (const double r : {inside + 0.05, outside - 0.05}) {
      const Vector3d at = out(total * share) * r;
      add_box(patches, at.head<2>(), 0.04, 0.05, 0, top - 0.2, total * share, false);
    }
  }
  return patches;
}

// Boxes in the part's frame, as extents with a yaw of their own about the part's origin.
struct Piece {
  Eigen::AlignedBox3d extent;
  double yaw_deg = 0.0;
};

std::vector<SurfacePatch> local_surface(const FurniturePart& f) {
  std::vector<SurfacePatch> patches;
  const Vector3d middle = f.extent.center(), size = f.extent.sizes();
  add_box(patches, middle.head<2>(), size.x(), size.y(), f.extent.min().z(), f.extent.max().z(), 0, true);
  return patches;
}

Eigen::AlignedBox3d box(double dx, double dy, double low, double high) {
  return {Vector3d(-dx / 2, -dy / 2, low), Vector3d(dx / 2, dy / 2, high)};
}

std::vector<Piece> pieces(const TableTopConveyor& c, bool) { return {{box(c.length, c.width, 0, c.height)}}; }

std::vector<Piece> pieces(const FloorConveyor& c, bool deck) {
  return {{box(c.length, c.width + 0.008, deck ? rail_top(c) - 0.2 : 0, rail_top(c))}};
}

std::vector<Piece> pieces(const CurveConveyor& c, bool deck) {
  std::vector<Piece> list;
  const int count = std::max(1, static_cast<int>(std::ceil(c.degrees / kPieceDeg)));
  const double half = to_radians(c.degrees / count / 2), inside = c.radius - c.width / 2, outside = c.radius + c.width / 2;
  for (int i = 0; i < count; ++i) {
    const Vector3d low(inside * std::cos(half), -outside * std::sin(half), deck ? rail_top(c) - 0.2 : 0);
    list.push_back({{low, Vector3d(outside, outside * std::sin(half), rail_top(c))}, (i + 0.5) * c.degrees / count});
  }
  return list;
}

std::vector<Piece> pieces(const FurniturePart& f, bool) { return {{f.extent}}; }

std::vector<Solid> placed_pieces(const PlannedObject& conveyor, bool deck) {
  std::vector<Solid> solids;
  for (const Piece& piece : std::visit([&](const auto& part) { return pieces(part, deck); }, conveyor.part)) {
    builder::Placement at = conveyor.at;
    at.yaw_deg += piece.yaw_deg;
    solids.push_back(solid_of(piece.extent, at));
  }
  return solids;
}

}  // namespace

std::string PlannedObject::kind() const {
  if (const auto* table_top = std::get_if<TableTopConveyor>(&part)) return table_top->rollers ? "table-top rollers" : "table-top belt";
  if (const auto* floor = std::get_if<FloorConveyor>(&part)) return floor->rollers ? "floor rollers" : "floor belt";
  if (const auto* furniture = std::get_if<FurniturePart>(&part)) return furniture->kind;
  return std::get<CurveConveyor>(part).belt ? "curve belt" : "curve rollers";
}

std::vector<Solid> PlannedObject::solids() const { return placed_pieces(*this, false); }
std::vector<Solid> PlannedObject::decks() const { return placed_pieces(*this, true); }

std::vector<SurfacePatch> PlannedObject::surface() const {
  std::vector<SurfacePatch> patches = std::visit([](const auto& p) { return local_surface(p); }, part);
  const Eigen::Isometry3d X_WO = at.pose();
  for (SurfacePatch& patch : patches) {
    patch.p_W = X_WO * patch.p_W;
    patch.normal = X_WO.linear() * patch.normal;
  }
  return patches;
}

Vector3d PlannedObject::middle() const { return at.pose() * extent_of(part).center(); }

Eigen::AlignedBox3d extent_of(const ObjectPart& part) {
  Eigen::AlignedBox3d extent;
  for (const Piece& piece : std::visit([](const auto& p) { return pieces(p, false); }, part)) {
    const Eigen::AngleAxisd R(to_radians(piece.yaw_deg), Vector3d::UnitZ());
    for (int corner = 0; corner < 8; ++corner) {
      extent.extend(R * piece.extent.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
  }
  return extent;
}

int add_planned_object(builder::Kit& kit, int parent, const PlannedObject& object) {
  struct Add {
    builder::Kit& kit;
    int parent;
    const PlannedObject& object;
    int operator()(TableTopConveyor c) const {
      c.name = object.name;
      return add_table_top_conveyor(kit, parent, object.at, c);
    }
    int operator()(FloorConveyor c) const {
      c.name = object.name;
      return add_floor_conveyor(kit, parent, object.at, c);
    }
    int operator()(CurveConveyor c) const {
      c.name = object.name;
      return add_curve_conveyor(kit, parent, object.at, c);
    }
    int operator()(const FurniturePart& f) const {
      const int node = kit.group(object.name, parent, object.at);
      kit.model.set_class(node, f.class_name);
      f.add(kit, node);
      return node;
    }
  };
  return std::visit(Add{kit, parent, object}, object.part);
}

}  // namespace waretwin::generate
