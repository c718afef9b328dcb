#include "scenes/builder/parts/home_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose.h"

namespace waretwin::builder {

int add_partition(Kit& kit, int parent, const std::string& name, const Partition& wall) {
  const Vector2d from(wall.x0, wall.y0), to(wall.x1, wall.y1);
  const double length = (to - from).norm(), yaw = to_degrees(std::atan2(to.y() - from.y(), to.x() - from.x())), half = kPartition / 2;
  std::vector<Opening> openings = wall.openings;
  std::sort(openings.begin(), openings.end(), [](const Opening& a, const Opening& b) { return a.along < b.along; });
  return kit.place(name, parent, {wall.x0, wall.y0, 0, yaw}, name, [&](MeshDraft& draft) {
    const int left = kit.material(wall.left), right = kit.material(wall.right), frame = kit.material("white_lacquer");
    const auto panel = [&](double x0, double z0, double x1, double z1) {
      if (x1 - x0 < 1e-6 || z1 - z0 < 1e-6) return;
      const Vector3d along(x1 - x0, 0, 0), up(0, 0, z1 - z0);
      for (Shape s : {rectangle({x1, half, z0}, -along, up), rectangle({x0, -half, z0}, along, up)}) {
        const bool is_left = s.normals[0].y() > 0;
        // One continuous texture around openings.
        for (Vector2d& uv : s.uv) uv = Vector2d((is_left ? -x1 : x0) + uv.x(), uv.y() - z1);
        draft.add(is_left ? left : right, s);
      }
    };
    const auto skirting = [&](double x0, double x1) {
      if (x1 - x0 < 1e-6) return;
      for (const double side : {-1.0, 1.0})
        draft.add(frame, standing_box(x1 - x0, 0.012, 0.07).move((x0 + x1) / 2, side * (half + 0.006), 0));
    };
    double x = 0;
    for (const Opening& o : openings) {
      panel(x, 0, o.along, wall.height);
      panel(o.along, 0, o.along + o.width, o.above);
      panel(o.along, o.above + o.height, o.along + o.width, wall.height);
      const double x0 = o.along, x1 = o.along + o.width, z0 = o.above, z1 = o.above + o.height;
      const Vector3d through(0, kPartition, 0);
      draft.add(frame, rectangle({x0, half, z0}, -through, {0, 0, z1 - z0}));
      draft.add(frame, rectangle({x1, -half, z0}, through, {0, 0, z1 - z0}));
      draft.add(frame, rectangle({x0, -half, z1}, through, {x1 - x0, 0, 0}));
      // The casing, 6 cm wide and 1 cm thick, on both sides.
      constexpr double kCasing = 0.06, kThick = 0.01;
      for (const double side : {-1.0, 1.0}) {
        const double y = side * (half + kThick / 2);
        for (const double edge : {x0 - kCasing / 2, x1 + kCasing / 2})
          draft.add(frame, standing_box(kCasing, kThick, z1 - z0).move(edge, y, z0));
        draft.add(frame, standing_box(x1 - x0 + 2 * kCasing, kThick, kCasing).move((x0 + x1) / 2, y, z1));
      }
      if (o.above < 1e-6) skirting(x + (x > 0 ? kCasing : 0), o.along - kCasing);
      x = x1;
    }
    panel(x, 0, length, wall.height);
    skirting(x + (x > 0 ? 0.06 : 0), length);
    // The ends, where no other wall hides them.
    draft.add(left, rectangle({0, half, 0}, {0, -kPartition, 0}, {0, 0, wall.height}));
    draft.add(left, rectangle({length, -half, 0}, {0, kPartition, 0}, {0, 0, wall.height}));
  });
}

int add_floor_area(Kit& kit, int parent, const std::string& name, const Eigen::AlignedBox2d& area, const std::string& finish) {
  return kit.place(name, parent, {}, name, [&](MeshDraft& draft) {
    draft.add(kit.material(finish), rectangle({area.min().x(), area.min().y(), 0}, {area.sizes().x(), 0, 0}, {0, area.sizes().y(), 0}));
  });
}

int add_ceiling_area(Kit& kit, int parent, const std::string& name, const Eigen::AlignedBox2d& area, double height) {
  return kit.place(name, parent, {}, name, [&](MeshDraft& draft) {
    draft.add(kit.material("ceiling"),
              rectangle({area.min().x(), area.max().y(), height}, {area.sizes().x(), 0, 0}, {0, -area.sizes().y(), 0}));
  });
}

void add_round_lamp(Kit& kit, int parent, const Placement& at, double intensity_cd) {
  const int node = kit.place("lamp", parent, at, "round_lamp", [&](MeshDraft& draft) {
    draft.add(kit.material("white_plastic"), turned({{0.205, -0.075}, {0.205, -0.002}, {0, -0.002}}, 28));
    draft.add(kit.material("lamp"), turned({{0, -0.09}, {0.16, -0.088}, {0.20, -0.076}}, 28));
  });
  // A little below the glass, so that it does not shade its own light.
  kit.model.add_lamp(node, Placement{0, 0, -0.14}.pose(),
                     {.name = "lamp_light",
                      .spot = true,
                      .intensity_cd = intensity_cd,
                      .colour = {1.0, 0.95, 0.86},
                      .radius_m = 0.18,
                      .inner_cone_deg = 50,
                      .outer_cone_deg = 88});
}

int add_floor_lamp(Kit& kit, int parent, const Placement& at) {
  return kit.place("floor_lamp", parent, at, "floor_lamp", [&](MeshDraft& draft) {
    draft.add(kit.material("dark_steel"), turned({{0, 0}, {0.15, 0}, {0.15, 0.02}, {0.012, 0.035}, {0.012, 1.3}, {0, 1.3}}, 20));
    draft.add(kit.material("lamp_shade"), turned({{0, 1.27}, {0.20, 1.27}, {0.14, 1.55}, {0, 1.55}}, 24));
  });
}

int add_table_lamp(Kit& kit, int parent, const Placement& at) {
  return kit.place("table_lamp", parent, at, "table_lamp", [&](MeshDraft& draft) {
    draft.add(kit.material("ceramic"),
              turned({{0, 0}, {0.06, 0}, {0.075, 0.06}, {0.05, 0.14}, {0.016, 0.19}, {0.012, 0.24}, {0, 0.24}}, 18));
    draft.add(kit.material("lamp_shade"), turned({{0, 0.23}, {0.13, 0.23}, {0.09, 0.42}, {0, 0.42}}, 20));
  });
}

void add_curtains(Kit& kit, int parent, const Placement& at, double width, double length) {
  kit.place("curtains", parent, at, "curtains_" + in_mm({width, length}), [&](MeshDraft& draft) {
    const double rod = width + 0.6;
    draft.add(kit.material("dark_steel"), cylinder({-rod / 2, 0.09, 0}, {rod / 2, 0.09, 0}, 0.012, 10));
    for (const double side : {-1.0, 1.0}) {
      // A wavy sheet: its outline in the plane, pushed up.
      constexpr int kSteps = 48;
      constexpr double kWide = 0.42, kSheet = 0.004;
      Profile outline;
      const auto wave = [&](int k) { return 0.028 * std::sin(2 * std::numbers::pi * 5 * k / kSteps); };
      for (int k = 0; k <= kSteps; ++k) outline.emplace_back(kWide * (static_cast<double>(k) / kSteps - 0.5), wave(k) - kSheet / 2);
      for (int k = kSteps; k >= 0; --k) outline.emplace_back(kWide * (static_cast<double>(k) / kSteps - 0.5), wave(k) + kSheet / 2);
      // The profile's plane is y-z and it grows along x: a third of a turn about the diagonal puts it level.
      Shape sheet = extruded(outline, length).rotate({1, 1, 1}, -120);
      draft.add(kit.material("curtain"), sheet.move(side * (width / 2 + 0.08), 0.09, -length / 2));
    }
  });
}

void add_wall_tiles(Kit& kit, int parent, const Placement& at, double width, double height, const std::string& finish) {
  kit.place("wall_tiles", parent, at, "wall_tiles_" + finish + in_mm({width, height}),
            [&](MeshDraft& draft) { draft.add(kit.material(finish), standing_box(width, 0.008, height).move(0, 0.004, 0)); });
}

int add_carpet(Kit& kit, int parent, const Placement& at, double length, double width, const std::string& finish) {
  return kit.place("carpet", parent, at, "carpet_" + finish + in_mm({length, width}),
                   [&](MeshDraft& draft) { draft.add(kit.material(finish), standing_box(length, width, kCarpet)); });
}

}  // namespace waretwin::builder
