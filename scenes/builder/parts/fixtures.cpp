#include "scenes/builder/parts/fixtures.h"

#include <algorithm>
#include <cmath>

namespace waretwin::builder {
namespace {

// Ellipses from what was turned: stretched along x and y, normals after it.
Shape stretched(Shape s, double fx, double fy) {
  for (Vector3d& p : s.positions) p = p.cwiseProduct(Vector3d(fx, fy, 1));
  for (Vector3d& n : s.normals) n = n.cwiseQuotient(Vector3d(fx, fy, 1)).normalized();
  return s;
}

// A tap that reaches towards -y.
void add_tap(Kit& kit, MeshDraft& draft, double x, double y, double z) {
  draft.add(kit.material("chrome"), cylinder({x, y, z}, {x, y, z + 0.05}, 0.02, 12));
  draft.add(kit.material("chrome"),
            tube(smooth_path({{x, y, z + 0.04}, {x, y, z + 0.17}, {x, y - 0.06, z + 0.22}, {x, y - 0.14, z + 0.17}}, 5), 0.011, 8));
  draft.add(kit.material("chrome"), bevelled_box(0.06, 0.014, 0.014, 0.003).move(x + 0.03, y, z + 0.055));
}

}  // namespace

int add_refrigerator(Kit& kit, int parent, const Placement& at, const Refrigerator& r) {
  return kit.place("refrigerator", parent, at, "refrigerator_" + in_mm({r.width, r.depth, r.height}) + r.finish, [&](MeshDraft& draft) {
    constexpr double kPlinth = 0.06, kDoor = 0.06, kGap = 0.008;
    const int body = kit.material(r.finish), dark = kit.material("black_plastic"), steel = kit.material("steel");
    const double depth = r.depth - kDoor - kGap;
    draft.add(dark, standing_box(r.width - 0.04, depth - 0.03, kPlinth).move(0, (r.depth - depth) / 2, 0));
    draft.add(body, standing_box(r.width, depth, r.height - kPlinth, 0.008).move(0, (r.depth - depth) / 2, kPlinth));
    // The seal between body and doors.
    draft.add(
        dark,
        standing_box(r.width - 0.03, kGap + 0.01, r.height - kPlinth - 0.03).move(0, -r.depth / 2 + kDoor + kGap / 2, kPlinth + 0.015));
    const double split = kPlinth + 0.40 * (r.height - kPlinth);
    const double front = -r.depth / 2;
    draft.add(body, standing_box(r.width, kDoor, split - kPlinth - 0.006, 0.012).move(0, front + kDoor / 2, kPlinth));
    draft.add(body, standing_box(r.width, kDoor, r.height - split, 0.012).move(0, front + kDoor / 2, split));
    for (const double z : {split - 0.20, split + 0.17}) {
      const double x = r.width / 2 - 0.05;
      draft.add(steel, cylinder({x, front - 0.03, z - 0.13}, {x, front - 0.03, z + 0.13}, 0.009, 10));
      for (const double end : {-0.11, 0.11}) draft.add(steel, cylinder({x, front + 0.005, z + end}, {x, front - 0.03, z + end}, 0.006, 8));
    }
    // A note under a magnet.
    draft.add(kit.material("paper"), rectangle({-0.14, front - 0.0008, split + 0.42}, {0.11, 0, 0}, {0, 0, 0.15}));
    draft.add(kit.material("fruit_red"),
              cylinder({-0.085, front - 0.001, split + 0.555}, {-0.085, front - 0.008, split + 0.555}, 0.014, 12));
  });
}

int add_counter(Kit& kit, int parent, const Placement& at, const Counter& c) {
  const std::string name = "counter_" + in_mm({c.length, c.depth}) + (c.sink ? "s" : "") + (c.hob ? "h" : "") + c.front;
  return kit.place("kitchen_counter", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kPlinth = 0.10, kTop = 0.90, kSlab = 0.035, kSinkWide = 0.48, kSinkDeep = 0.38, kSinkLow = 0.72;
    const int front = kit.material(c.front), slab = kit.material("worktop"), steel = kit.material("steel");
    const double body = c.depth - 0.04;
    draft.add(kit.material("black_plastic"), standing_box(c.length, body - 0.06, kPlinth).move(0, 0.05, 0));
    const double sink_x = -c.length / 2 + std::min(0.45, c.length / 4 + 0.1), low = kTop - kSlab;
    const auto block = [&](double x0, double x1, double top) {
      draft.add(front, standing_box(x1 - x0, body - 0.02, top - kPlinth).move((x0 + x1) / 2, 0.03, kPlinth));
    };
    if (c.sink) {
      block(-c.length / 2, sink_x - kSinkWide / 2, low);
      block(sink_x - kSinkWide / 2, sink_x + kSinkWide / 2, kSinkLow);
      block(sink_x + kSinkWide / 2, c.length / 2, low);
    } else {
      block(-c.length / 2, c.length / 2, low);
    }
    const int units = std::max(2, static_cast<int>(std::lround(c.length / 0.6)));
    const double each = c.length / units, y = 0.03 - (body - 0.02) / 2 - 0.009;
    for (int i = 0; i < units; ++i) {
      const double x = (i - 0.5 * (units - 1)) * each, high = kTop - kSlab - kPlinth;
      const bool drawers = i % 2 == 1;
      for (int k = 0; k < (drawers ? 3 : 1); ++k) {
        const double h = drawers ? high / 3 : high, z = kPlinth + k * h;
        draft.add(front, standing_box(each - 0.006, 0.018, h - 0.006, 0.003).move(x, y, z + 0.003));
        draft.add(steel, bevelled_box(0.18, 0.022, 0.012, 0.003).move(x, y - 0.018, z + h - 0.05));
      }
    }
    // The worktop, with a hole where the sink is.
    if (c.sink) {
      const double left = sink_x - kSinkWide / 2 + c.length / 2, right = c.length / 2 - sink_x - kSinkWide / 2,
                   rim = (c.depth - kSinkDeep) / 2;
      draft.add(slab, standing_box(left, c.depth, kSlab).move(-c.length / 2 + left / 2, 0, low));
      draft.add(slab, standing_box(right, c.depth, kSlab).move(c.length / 2 - right / 2, 0, low));
      for (const double side : {-1.0, 1.0}) {
        draft.add(slab, standing_box(kSinkWide, rim, kSlab).move(sink_x, side * (c.depth - rim) / 2, low));
        draft.add(steel, standing_box(kSinkWide, 0.012, kTop - kSinkLow + 0.004).move(sink_x, side * (kSinkDeep / 2 - 0.006), kSinkLow));
        draft.add(
            steel,
            standing_box(0.012, kSinkDeep - 0.024, kTop - kSinkLow + 0.004).move(sink_x + side * (kSinkWide / 2 - 0.006), 0, kSinkLow));
      }
      draft.add(steel, standing_box(kSinkWide - 0.02, kSinkDeep - 0.02, 0.006).move(sink_x, 0, kSinkLow));
      draft.add(kit.material("dark_hollow"), turned({{0.03, 0.007}, {0, 0.008}}, 14).move(sink_x, 0, kSinkLow));
      add_tap(kit, draft, sink_x, kSinkDeep / 2 + 0.05, kTop);
    } else {
      draft.add(slab, standing_box(c.length, c.depth, kSlab, 0.004).move(0, 0, low));
    }
    if (c.hob) {
      const double hob_x = c.length / 2 - std::min(0.45, c.length / 4 + 0.1);
      draft.add(kit.material("black_glass"), standing_box(0.56, 0.50, 0.006, 0.002).move(hob_x, 0, kTop));
      for (const double dx : {-0.13, 0.13}) {
        for (const double dy : {-0.11, 0.11}) {
          const double r = dx * dy > 0 ? 0.09 : 0.07;
          draft.add(kit.material("grey_plastic"), turned({{r, 0.0065}, {r - 0.008, 0.0066}}, 24).move(hob_x + dx, dy, kTop));
        }
      }
    }
  });
}

int add_wall_cupboards(Kit& kit, int parent, const Placement& at, double length, const std::string& front) {
  return kit.place("wall_cupboards", parent, at, "wall_cupboards_" + in_mm({length}) + front, [&](MeshDraft& draft) {
    constexpr double kDeep = 0.34, kHigh = 0.65;
    draft.add(kit.material("white_lacquer"), standing_box(length, kDeep - 0.02, kHigh).move(0, 0.01, 0));
    const int units = std::max(1, static_cast<int>(std::lround(length / 0.6)));
    for (int i = 0; i < units; ++i) {
      const double each = length / units, x = (i - 0.5 * (units - 1)) * each;
      draft.add(kit.material(front), standing_box(each - 0.006, 0.018, kHigh - 0.006, 0.003).move(x, -kDeep / 2 + 0.01, 0.003));
      draft.add(kit.material("steel"),
                bevelled_box(0.012, 0.02, 0.14, 0.003).move(x + (i % 2 == 0 ? 1 : -1) * (each / 2 - 0.05), -kDeep / 2 - 0.007, 0.12));
    }
  });
}

int add_pot(Kit& kit, int parent, const Placement& at) {
  return kit.place("pot", parent, at, "pot", [&](MeshDraft& draft) {
    draft.add(kit.material("steel"), turned({{0, 0}, {0.095, 0}, {0.10, 0.01}, {0.10, 0.12}, {0.103, 0.125}, {0, 0.135}}, 24));
    draft.add(kit.material("black_plastic"), turned({{0, 0.133}, {0.02, 0.133}, {0.024, 0.155}, {0, 0.158}}, 14));
    for (const double side : {-1.0, 1.0})
      draft.add(kit.material("black_plastic"), bevelled_box(0.05, 0.03, 0.016, 0.005).move(side * 0.118, 0, 0.10));
  });
}

int add_toilet(Kit& kit, int parent, const Placement& at) {
  return kit.place("toilet", parent, at, "toilet", [&](MeshDraft& draft) {
    const int ceramic = kit.material("ceramic"), plastic = kit.material("white_plastic");
    // The bowl reaches from y = -0.34 to 0.14, the cistern stands behind it.
    const auto bowl = [](const Profile& p) { return stretched(turned(p, 28), 1.0, 1.30).move(0, -0.095, 0); };
    draft.add(ceramic, bowl({{0, 0},
                             {0.125, 0},
                             {0.115, 0.05},
                             {0.11, 0.16},
                             {0.165, 0.30},
                             {0.185, 0.37},
                             {0.188, 0.39},
                             {0.14, 0.39},
                             {0.10, 0.28},
                             {0, 0.24}}));
    draft.add(ceramic, standing_box(0.20, 0.26, 0.385, 0.03).move(0, 0.20, 0));
    // Seat and closed lid.
    draft.add(plastic, bowl({{0.13, 0.395}, {0.186, 0.395}, {0.188, 0.41}, {0.13, 0.41}}));
    draft.add(plastic, bowl({{0, 0.413}, {0.186, 0.413}, {0.188, 0.425}, {0.17, 0.435}, {0, 0.44}}));
    draft.add(plastic, standing_box(0.20, 0.04, 0.04, 0.008).move(0, 0.135, 0.395));
    draft.add(ceramic, standing_box(0.39, 0.18, 0.37, 0.025).move(0, 0.25, 0.40));
    draft.add(ceramic, standing_box(0.39, 0.185, 0.03, 0.01).move(0, 0.2475, 0.76));
    draft.add(kit.material("chrome"), turned({{0, 0.79}, {0.03, 0.79}, {0.028, 0.797}, {0, 0.798}}, 16).move(0, 0.25, 0));
  });
}

int add_washbasin(Kit& kit, int parent, const Placement& at) {
  return kit.place("washbasin", parent, at, "washbasin", [&](MeshDraft& draft) {
    const int ceramic = kit.material("ceramic");
    draft.add(ceramic,
              stretched(turned({{0, 0}, {0.10, 0}, {0.075, 0.08}, {0.07, 0.60}, {0.09, 0.72}, {0, 0.72}}, 20), 1.0, 0.9).move(0, 0.08, 0));
    draft.add(ceramic, stretched(turned({{0, 0.68}, {0.10, 0.69}, {0.24, 0.76}, {0.28, 0.85}, {0.255, 0.85}, {0.21, 0.78}, {0, 0.745}}, 32),
                                 1.0, 0.72)
                           .move(0, -0.01, 0));
    draft.add(ceramic, bevelled_box(0.44, 0.12, 0.10, 0.02).move(0, 0.16, 0.80));
    draft.add(kit.material("chrome"), turned({{0.022, 0.749}, {0, 0.752}}, 12).move(0, -0.01, 0));
    add_tap(kit, draft, 0, 0.16, 0.85);
  });
}

int add_bathtub(Kit& kit, int parent, const Placement& at, double length, double width) {
  return kit.place("bathtub", parent, at, "bathtub_" + in_mm({length, width}), [&](MeshDraft& draft) {
    constexpr double kHigh = 0.58, kRim = 0.07, kFloor = 0.16;
    const int ceramic = kit.material("ceramic");
    for (const double side : {-1.0, 1.0}) {
      draft.add(ceramic, standing_box(length, kRim, kHigh, 0.012).move(0, side * (width - kRim) / 2, 0));
      draft.add(ceramic, standing_box(kRim * 1.5, width - kRim, kHigh, 0.012).move(side * (length - 1.5 * kRim) / 2, 0, 0));
    }
    draft.add(ceramic, standing_box(length - kRim, width - kRim, kFloor).move(0, 0, 0));
    draft.add(kit.material("chrome"), tube(smooth_path({{length / 2 - 0.05, 0, kHigh - 0.01},
                                                        {length / 2 - 0.05, 0, kHigh + 0.10},
                                                        {length / 2 - 0.10, 0, kHigh + 0.13},
                                                        {length / 2 - 0.17, 0, kHigh + 0.09}},
                                                       5),
                                           0.014, 8));
  });
}

}  // namespace waretwin::builder
