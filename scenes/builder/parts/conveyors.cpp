#include "scenes/builder/parts/conveyors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose.h"

namespace waretwin::builder {
namespace {

// A belt's closed loop in the x-z plane: straight above and below, round at both ends. Extruded along y.
Shape belt_loop(double length, double width, double top, double thickness) {
  // extruded() runs along x with the profile in y-z; turned by -90 deg about z, its y becomes x.
  Profile loop;
  const double r = thickness / 2;
  for (int k = 0; k <= 8; ++k) {
    const double a = std::numbers::pi * (k / 8.0 - 0.5);
    loop.emplace_back(length / 2 - r + r * std::cos(a), top - r + r * std::sin(a));
  }
  for (int k = 0; k <= 8; ++k) {
    const double a = std::numbers::pi * (k / 8.0 + 0.5);
    loop.emplace_back(-length / 2 + r + r * std::cos(a), top - r + r * std::sin(a));
  }
  return extruded(loop, width).rotate(Vector3d::UnitZ(), -90);
}

// A T-slot profile seen from its end, slots on the outer side (y > 0), from z = 0.
Profile slotted_profile(double width, double height) {
  const double w = width / 2, s = 0.008, d = 0.007;
  const double low = 0.28 * height, high = 0.72 * height;
  return {{-w, 0},
          {w, 0},
          {w, low - s / 2},
          {w - d, low - s / 2},
          {w - d, low + s / 2},
          {w, low + s / 2},
          {w, high - s / 2},
          {w - d, high - s / 2},
          {w - d, high + s / 2},
          {w, high + s / 2},
          {w, height},
          {-w, height}};
}

// What a mesh's name says of a finish that is not the usual one.
std::string marked(const std::string& finish, const std::string& usual) { return finish == usual ? "" : "_" + finish; }

Shape bolt(const Vector3d& at, const Vector3d& out, double radius) { return cylinder(at, at + out * 0.0045, radius, 6); }

}  // namespace

int add_table_top_conveyor(Kit& kit, int parent, const Placement& at, const TableTopConveyor& c) {
  const TableTopConveyor usual;
  const std::string mesh_name = std::string("table_top_conveyor_") + (c.rollers ? "rollers_" : "belt_") +
                                in_mm({c.length, c.width, c.height}) + marked(c.rail, usual.rail) +
                                (c.rollers ? marked(c.roller, usual.roller) : marked(c.belt, usual.belt));
  const int node = kit.place(c.name, parent, at, mesh_name, [&](MeshDraft& draft) {
    const double rail_height = 0.042, profile_width = 0.036, profile_height = c.height - rail_height - 0.022;
    const double inset = 0.005;  // bolts stay inside the rail's outline
    // The base rail: two green beams along, joined by two cross beams and a floor plate.
    for (const double side : {-1.0, 1.0}) {
      draft.add(kit.material(c.rail), standing_box(c.length, 0.075, rail_height, 0.004).move(0, side * (c.width / 2 - 0.0375), 0));
      draft.add(kit.material(c.rail), standing_box(0.06, c.width - 0.15, rail_height - 0.006).move(side * (c.length / 2 - 0.05), 0, 0));
      // Side profile, slots outside.
      Shape profile = extruded(slotted_profile(profile_width, profile_height), c.length - 0.012);
      if (side < 0) profile.rotate(Vector3d::UnitZ(), 180);
      draft.add(kit.material("aluminium"), profile.move(0, side * (c.width / 2 - inset - profile_width / 2), rail_height));
      const int bolts = static_cast<int>(std::lround(c.length / 0.075));
      for (int i = 0; i < bolts; ++i) {
        const double x = (i + 0.5 - bolts / 2.0) * (c.length - 0.05) / bolts;
        draft.add(kit.material("dark_steel"),
                  bolt({x, side * (c.width / 2 - inset), rail_height + profile_height / 2}, {0, side, 0}, 0.0065));
      }
      // End plates, up to the belt or the rollers' axles.
      const double plate = (c.rollers ? c.height - 0.022 : c.height - 0.051) - rail_height;
      const double plate_inset = c.rollers ? 0.005 : 0.03;  // where the belt runs level
      draft.add(
          kit.material("black_plastic"),
          standing_box(0.006, c.width - 2 * inset - 2 * profile_width, plate).move(side * (c.length / 2 - plate_inset), 0, rail_height));
    }
    draft.add(kit.material("dark_steel"), standing_box(c.length - 0.08, c.width - 0.10, 0.012).move(0, 0, rail_height - 0.008));
    if (c.rollers) {
      // A cover between the rollers, so that nothing falls through.
      draft.add(kit.material("dark_steel"),
                standing_box(c.length - 0.012, c.width - 2 * (inset + profile_width), 0.004).move(0, 0, c.height - 0.024));
    }
    const double between = c.width - 2 * (inset + profile_width) - 0.006;
    if (c.rollers) {
      const double r = 0.025;
      const int count = static_cast<int>((c.length - 2 * r) / c.roller_pitch) + 1;
      for (int i = 0; i < count; ++i) {
        const double x = (i - (count - 1) / 2.0) * (c.length - 2 * r - 0.004) / (count - 1);
        draft.add(kit.material(c.roller), cylinder({x, -between / 2, c.height - r}, {x, between / 2, c.height - r}, r, 20));
        for (const double side : {-1.0, 1.0}) {
          draft.add(kit.material("steel"),
                    cylinder({x, side * between / 2, c.height - r}, {x, side * (between / 2 + 0.006), c.height - r}, 0.007, 8));
        }
      }
    } else {
      draft.add(kit.material(c.belt), belt_loop(c.length - 0.004, between, c.height, 0.052));
    }
  });
  kit.place(c.name + "_label", node, {0.16 - c.length / 2, -c.width / 2 + 0.0045, 0.062}, "label_type_90x45", [&](MeshDraft& draft) {
    draft.add(kit.material("label_type"), picture({-0.04, 0, 0}, {0.08, 0, 0}, {0, 0, 0.04}));
  });
  kit.model.set_class(node, "conveyor");
  return node;
}

int add_floor_conveyor(Kit& kit, int parent, const Placement& at, const FloorConveyor& c) {
  const std::string kind = c.rollers ? "roller" : "belt";
  const std::string frame = c.frame.empty() ? (c.rollers ? "green_paint" : "blue_paint") : c.frame;
  const std::string size = in_mm({c.length, c.width, c.height}) + marked(c.frame, "") + (c.rollers ? "" : marked(c.belt, "rubber_belt"));
  const double frame_height = 0.12, frame_width = 0.03, inner = c.width - 2 * frame_width;
  const double rail_top = c.height + (c.rollers ? 0.02 : 0.01);
  const int node = kit.group(c.name, parent, at);
  kit.place(c.name + "_frame", node, {}, "floor_conveyor_" + kind + "_" + size, [&](MeshDraft& draft) {
    for (const double side : {-1.0, 1.0}) {
      const double y = side * (c.width - frame_width) / 2;
      draft.add(kit.material(frame), bevelled_box(c.length, frame_width, frame_height, 0.004).move(0, y, rail_top - frame_height / 2));
      const int bolts = std::max(2, static_cast<int>(c.length / 0.2));
      for (int i = 0; i < bolts; ++i) {
        const double x = (i + 0.5) / bolts * c.length - c.length / 2;
        draft.add(kit.material("dark_steel"), cylinder({x, side * (c.width / 2 - 0.001), rail_top - 0.05},
                                                       {x, side * (c.width / 2 + 0.004), rail_top - 0.05}, 0.008, 6));
      }
    }
    if (!c.rollers) draft.add(kit.material(c.belt), belt_loop(c.length - 0.01, inner - 0.02, c.height, 0.09));
    // Legs every two metres at most.
    const int pairs = std::max(2, static_cast<int>(std::ceil(c.length / 2.0)) + 1);
    for (int i = 0; i < pairs; ++i) {
      const double x = (c.length - 0.3) * (i / (pairs - 1.0) - 0.5);
      for (const double side : {-1.0, 1.0}) {
        const double y = side * (c.width / 2 - 0.05);
        draft.add(kit.material("galvanised"), standing_box(0.05, 0.04, rail_top - 0.10).move(x, y, 0.01));
        draft.add(kit.material("rubber"), standing_box(0.09, 0.07, 0.012).move(x, y, 0));
      }
      draft.add(kit.material("galvanised"), standing_box(0.03, c.width - 0.12, 0.04).move(x, 0, 0.22));
      draft.add(kit.material("galvanised"), standing_box(0.04, c.width - 0.08, 0.05).move(x, 0, rail_top - 0.17));
    }
    // The drive below the frame.
    draft.add(kit.material("black_paint"), bevelled_box(0.26, 0.16, 0.14, 0.01).move(0.2, 0, rail_top - 0.19));
    draft.add(kit.material("light_grey_paint"), bevelled_box(0.16, 0.03, 0.10, 0.006).move(-0.3, -(c.width / 2 - 0.015), rail_top - 0.17));
  });
  if (c.rollers) {
    const int count = std::max(2, static_cast<int>(c.length / c.roller_pitch));
    const int roller = kit.mesh("roller_" + in_mm({inner}) + marked(c.roller, "roller_steel"), [&](MeshDraft& draft) {
      draft.add(kit.material(c.roller), cylinder({0, -inner / 2, 0}, {0, inner / 2, 0}, 0.025, 14));
    });
    for (int i = 0; i < count; ++i) {
      const double x = ((i + 0.5) / count - 0.5) * c.length;
      kit.model.add_node("roller", node, Placement{x, 0, c.height - 0.025}, roller);
    }
  }
  kit.model.set_class(node, "conveyor");
  return node;
}

int add_curve_conveyor(Kit& kit, int parent, const Placement& at, const CurveConveyor& c) {
  const std::string size = in_mm({c.radius, c.width, c.height}) + "_" + std::to_string(std::lround(c.degrees)) + marked(c.frame, "") +
                           (c.belt ? marked(c.belt_finish, "rubber_belt") : "");
  const double frame_height = 0.12, frame_width = 0.03, rail_top = c.height + (c.belt ? 0.01 : 0.02);
  const double inside = c.radius - c.width / 2, outside = c.radius + c.width / 2, inner = c.width - 2 * frame_width;
  const int steps = std::max(4, static_cast<int>(c.degrees / 6));
  const int node = kit.group(c.name, parent, at);
  kit.place(c.name + "_frame", node, {}, std::string("curve_conveyor_") + (c.belt ? "belt_" : "roller_") + size, [&](MeshDraft& draft) {
    const auto ring = [&](double r0, double r1, double z0, double z1) {
      return swept({{r0, z0}, {r1, z0}, {r1, z1}, {r0, z1}}, c.degrees, steps);
    };
    const int paint = kit.material(c.frame.empty() ? (c.belt ? "blue_paint" : "green_paint") : c.frame);
    draft.add(paint, ring(inside, inside + frame_width, rail_top - frame_height, rail_top));
    draft.add(paint, ring(outside - frame_width, outside, rail_top - frame_height, rail_top));
    if (c.belt)
      draft.add(kit.material(c.belt_finish), ring(inside + frame_width + 0.01, outside - frame_width - 0.01, c.height - 0.05, c.height));
    for (const double share : {0.08, 0.5, 0.92}) {
      const double a = to_radians(c.degrees * share);
      const Vector3d out(std::cos(a), std::sin(a), 0);
      for (const double r : {inside + 0.05, outside - 0.05}) {
        draft.add(
            kit.material("galvanised"),
            standing_box(0.04, 0.05, rail_top - 0.10).rotate(Vector3d::UnitZ(), c.degrees * share).move(r * out.x(), r * out.y(), 0.01));
        draft.add(kit.material("rubber"),
                  standing_box(0.07, 0.08, 0.012).rotate(Vector3d::UnitZ(), c.degrees * share).move(r * out.x(), r * out.y(), 0));
      }
      draft.add(kit.material("galvanised"), standing_box(c.width - 0.1, 0.03, 0.04)
                                                .rotate(Vector3d::UnitZ(), c.degrees * share)
                                                .move(c.radius * out.x(), c.radius * out.y(), 0.22));
    }
  });
  if (!c.belt) {
    const int roller = kit.mesh("curve_roller_" + in_mm({inner}) + marked(c.roller, "roller_steel"), [&](MeshDraft& draft) {
      draft.add(kit.material(c.roller),
                turned({{0, 0}, {0.018, 0}, {0.027, inner}, {0, inner}}, 14).rotate(Vector3d::UnitY(), 90).move(-inner / 2, 0, 0));
    });
    const int count = static_cast<int>(c.degrees / c.roller_pitch_deg);
    for (int i = 0; i < count; ++i) {
      const double degrees = (i + 0.5) * c.degrees / count, a = to_radians(degrees);
      kit.model.add_node("roller", node, Placement{c.radius * std::cos(a), c.radius * std::sin(a), c.height - 0.027, degrees}, roller);
    }
  }
  kit.model.set_class(node, "conveyor");
  return node;
}

}  // namespace waretwin::builder
