#include "scenes/builder/parts/room.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"

namespace waretwin::builder {

int add_wall(Kit& kit, int parent, const std::string& name, const Wall& wall) {
  const Vector2d from(wall.x0, wall.y0), to(wall.x1, wall.y1);
  const double length = (to - from).norm(), yaw = to_degrees(std::atan2(to.y() - from.y(), to.x() - from.x()));
  std::vector<Opening> openings = wall.openings;
  std::sort(openings.begin(), openings.end(), [](const Opening& a, const Opening& b) { return a.along < b.along; });
  return kit.place(name, parent, {wall.x0, wall.y0, 0, yaw}, name, [&](MeshDraft& draft) {
    // Seen from the room (left of the wall) x runs to the right when y points away, so the face is turned to +y.
    const auto panel = [&](double x0, double z0, double x1, double z1) {
      if (x1 - x0 < 1e-6 || z1 - z0 < 1e-6) return;
      Shape s = rectangle({x1, 0, z0}, {x0 - x1, 0, 0}, {0, 0, z1 - z0});
      for (Vector2d& uv : s.uv) uv = Vector2d(-x1 + uv.x(), uv.y() - z1);  // one continuous texture around openings
      draft.add(kit.material(wall.finish), s);
    };
    double x = 0;
    for (const Opening& o : openings) {
      panel(x, 0, o.along, wall.height);
      panel(o.along, 0, o.along + o.width, o.above);
      panel(o.along, o.above + o.height, o.along + o.width, wall.height);
      x = o.along + o.width;
    }
    panel(x, 0, length, wall.height);
    double s = 0;
    const auto skirting = [&](double x0, double x1) {
      if (x1 - x0 > 1e-6) draft.add(kit.material("skirting"), standing_box(x1 - x0, 0.015, 0.09).move((x0 + x1) / 2, 0.0075, 0));
    };
    for (const Opening& o : openings) {
      if (o.above > 0.09) continue;
      skirting(s, o.along);
      s = o.along + o.width;
    }
    skirting(s, length);
  });
}

int add_floor(Kit& kit, int parent, double length, double width, const std::string& finish) {
  return kit.place("floor", parent, {}, "floor", [&](MeshDraft& draft) {
    draft.add(kit.material(finish), rectangle({-length / 2, -width / 2, 0}, {length, 0, 0}, {0, width, 0}));
  });
}

int add_ceiling(Kit& kit, int parent, double length, double width, double height) {
  return kit.place("ceiling", parent, {}, "ceiling", [&](MeshDraft& draft) {
    draft.add(kit.material("ceiling"), rectangle({-length / 2, width / 2, height}, {length, 0, 0}, {0, -width, 0}));
  });
}

void add_floor_tape(Kit& kit, int parent, const std::string& name, const std::vector<Vector2d>& path, double width,
                    const std::string& finish) {
  kit.place(name, parent, {}, name, [&](MeshDraft& draft) {
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const Vector2d along = (path[i + 1] - path[i]).normalized(), left(-along.y(), along.x());
      const Vector2d a = path[i] - along * (i > 0 ? -width / 2 : width / 2) - left * width / 2;
      const Vector2d edge = path[i + 1] + along * width / 2 - left * width / 2 - a;
      draft.add(kit.material(finish), rectangle({a.x(), a.y(), 0.0008}, {edge.x(), edge.y(), 0}, {left.x() * width, left.y() * width, 0}));
    }
  });
}

void add_tyre_marks(Kit& kit, int parent, const std::vector<Vector2d>& path) {
  const std::string name = "tyre_marks_" + in_mm({path[0].x(), path[0].y()});
  kit.place(name, parent, {}, name, [&](MeshDraft& draft) {
    std::vector<Vector3d> points;
    for (const Vector2d& p : path) points.emplace_back(p.x(), p.y(), 0);
    points = smooth_path(points, 8);
    Shape s;
    double along = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d direction = (points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0]).normalized();
      const Vector3d left(-direction.y() * 0.06, direction.x() * 0.06, 0);
      if (i > 0) along += (points[i] - points[i - 1]).norm();
      for (const double side : {-1.0, 1.0}) {
        s.positions.push_back(points[i] + side * left + Vector3d(0, 0, 0.0004));
        s.normals.push_back(Vector3d::UnitZ());
        s.uv.emplace_back(along, side < 0 ? 0.12 : 0.0);
      }
      if (i == 0) continue;
      const auto n = static_cast<std::uint32_t>(2 * i);
      s.triangles.insert(s.triangles.end(), {n - 2, n, n + 1, n - 2, n + 1, n - 1});
    }
    draft.add(kit.material("tyre_marks"), s);
  });
}

void add_ceiling_lamp(Kit& kit, int parent, const Placement& at, double intensity_cd) {
  const int node = kit.place("lamp", parent, at, "ceiling_lamp", [&](MeshDraft& draft) {
    draft.add(kit.material("light_grey_paint"), standing_box(1.24, 0.34, 0.06, 0.005).move(0, 0, 0.004));
    draft.add(kit.material("lamp"), rectangle({-0.6, 0.15, 0.002}, {1.2, 0, 0}, {0, -0.3, 0}));
  });
  // A little below the panel, so that the panel does not shade its own light.
  kit.model.add_lamp(node, Placement{0, 0, -0.06}.pose(),
                     {.name = "lamp_light",
                      .spot = true,
                      .intensity_cd = intensity_cd,
                      .colour = {1.0, 0.97, 0.92},
                      .radius_m = 0.25,
                      .inner_cone_deg = 45,
                      .outer_cone_deg = 85});
}

void add_window(Kit& kit, int parent, const Placement& at, double width, double height) {
  kit.place("window", parent, at, "window_" + in_mm({width, height}), [&](MeshDraft& draft) {
    const double f = 0.06, depth = 0.12;
    draft.add(kit.material("daylight"), rectangle({width / 2, -depth, 0}, {-width, 0, 0}, {0, 0, height}));
    const int frame = kit.material("window_frame");
    for (const double x : {-width / 2 + f / 2, 0.0, width / 2 - f / 2})
      draft.add(frame, standing_box(f, 0.07, height).move(x, -depth + 0.04, 0));
    for (const double z : {0.0, height - f}) draft.add(frame, standing_box(width, 0.07, f).move(0, -depth + 0.04, z));
    // Reveal and sill.
    const int reveal = kit.material("ceiling");
    draft.add(reveal, rectangle({-width / 2, 0, 0}, {0, -depth, 0}, {0, 0, height}));
    draft.add(reveal, rectangle({width / 2, -depth, 0}, {0, depth, 0}, {0, 0, height}));
    draft.add(reveal, rectangle({-width / 2, 0, height}, {0, -depth, 0}, {width, 0, 0}));
    draft.add(frame, standing_box(width + 0.1, 0.2, 0.03, 0.006).move(0, -0.02, -0.03));
  });
}

void add_door(Kit& kit, int parent, const Placement& at, double width, double height) {
  kit.place("door", parent, at, "door_" + in_mm({width, height}), [&](MeshDraft& draft) {
    draft.add(kit.material("door_paint"), standing_box(width, 0.04, height, 0.004).move(0, -0.02, 0.005));
    for (const double side : {-1.0, 1.0}) {
      draft.add(kit.material("window_frame"), standing_box(0.07, 0.10, height + 0.07).move(side * (width / 2 + 0.035), 0.0, 0));
    }
    draft.add(kit.material("window_frame"), standing_box(width, 0.10, 0.065).move(0, 0.0, height + 0.005));
    draft.add(kit.material("chrome"), cylinder({width / 2 - 0.08, 0, 1.05}, {width / 2 - 0.08, 0.05, 1.05}, 0.01, 8));
    draft.add(kit.material("chrome"), cylinder({width / 2 - 0.07, 0.05, 1.05}, {width / 2 - 0.20, 0.05, 1.05}, 0.01, 8));
    draft.add(kit.material("steel"), standing_box(width - 0.1, 0.004, 0.2).move(0, 0.002, 0.05));
  });
}

void add_gate(Kit& kit, int parent, const Placement& at, double width, double height) {
  kit.place("gate", parent, at, "gate_" + in_mm({width, height}), [&](MeshDraft& draft) {
    const int panels = std::max(1, static_cast<int>(std::lround(height / 0.5)));
    for (int i = 0; i < panels; ++i) {
      draft.add(kit.material("gate"), standing_box(width, 0.05, height / panels - 0.012, 0.01).move(0, -0.02, i * height / panels));
    }
    for (const double side : {-1.0, 1.0}) {
      draft.add(kit.material("yellow_paint"), standing_box(0.1, 0.12, height).move(side * (width / 2 + 0.05), 0.02, 0));
    }
  });
}

void add_wall_picture(Kit& kit, int parent, const Placement& at, double width, double height, const std::string& finish) {
  kit.place(finish, parent, at, finish + "_" + in_mm({width, height}), [&](MeshDraft& draft) {
    draft.add(kit.material("black_plastic"), standing_box(width + 0.01, 0.01, height + 0.01).move(0, 0.006, -0.005));
    draft.add(kit.material(finish), picture({width / 2, 0.012, 0}, {-width, 0, 0}, {0, 0, height}));
  });
}

void add_cable_duct(Kit& kit, int parent, const Placement& at, double length) {
  kit.place("cable_duct", parent, at, "cable_duct_" + in_mm({length}), [&](MeshDraft& draft) {
    draft.add(kit.material("duct"), standing_box(length, 0.06, 0.13, 0.004).move(0, 0.03, 0));
    for (double x = -length / 2 + 0.5; x < length / 2 - 0.2; x += 1.2) {
      for (const double side : {-0.045, 0.045}) {
        draft.add(kit.material("white_plastic"), standing_box(0.08, 0.008, 0.08, 0.003).move(x + side, 0.063, 0.025));
        draft.add(kit.material("grey_plastic"), cylinder({x + side, 0.066, 0.065}, {x + side, 0.0675, 0.065}, 0.024, 12));
      }
    }
  });
}

void add_radiator(Kit& kit, int parent, const Placement& at, double length) {
  kit.place("radiator", parent, at, "radiator_" + in_mm({length}), [&](MeshDraft& draft) {
    draft.add(kit.material("light_grey_paint"), standing_box(length, 0.03, 0.5, 0.004).move(0, 0.05, 0.15));
    const int fins = static_cast<int>(length / 0.06);
    for (int i = 0; i < fins; ++i) {
      draft.add(kit.material("light_grey_paint"), standing_box(0.03, 0.03, 0.46).move((i + 0.5) / fins * length - length / 2, 0.08, 0.17));
    }
    draft.add(kit.material("steel"), cylinder({length / 2 - 0.05, 0.05, 0}, {length / 2 - 0.05, 0.05, 0.15}, 0.01, 8));
  });
}

void add_switch_box(Kit& kit, int parent, const Placement& at) {
  kit.place("switch_box", parent, at, "switch_box", [&](MeshDraft& draft) {
    draft.add(kit.material("light_grey_paint"), standing_box(0.5, 0.2, 0.7, 0.008).move(0, 0.1, 0));
    draft.add(kit.material("black_plastic"), standing_box(0.03, 0.02, 0.08, 0.003).move(0.2, 0.21, 0.3));
    draft.add(kit.material("red_paint"), cylinder({-0.12, 0.2, 0.52}, {-0.12, 0.24, 0.52}, 0.03, 14));
    draft.add(kit.material("label_warning"), picture({0.06, 0.201, 0.42}, {-0.1, 0, 0}, {0, 0, 0.1}));
    draft.add(kit.material("duct"), standing_box(0.06, 0.06, 1.2).move(0.1, 0.03, 0.7));
  });
}

void add_fire_extinguisher(Kit& kit, int parent, const Placement& at) {
  kit.place("fire_extinguisher", parent, at, "fire_extinguisher", [&](MeshDraft& draft) {
    draft.add(
        kit.material("red_paint"),
        turned({{0, 0}, {0.075, 0}, {0.08, 0.02}, {0.08, 0.42}, {0.06, 0.47}, {0.025, 0.5}, {0.025, 0.53}, {0, 0.53}}, 18).move(0, 0.1, 0));
    draft.add(kit.material("black_plastic"), standing_box(0.03, 0.12, 0.04, 0.004).move(0, 0.13, 0.53));
    draft.add(kit.material("rubber"),
              tube(smooth_path({{0, 0.14, 0.54}, {0.09, 0.14, 0.5}, {0.1, 0.14, 0.3}, {0.09, 0.13, 0.12}}, 5), 0.011, 8));
    draft.add(kit.material("steel"), standing_box(0.05, 0.02, 0.3).move(0, 0.01, 0.15));
  });
}

}  // namespace waretwin::builder
