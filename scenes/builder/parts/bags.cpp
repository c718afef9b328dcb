#include "scenes/builder/parts/bags.h"

namespace waretwin::builder {

int add_backpack(Kit& kit, int parent, const Placement& at, const std::string& canvas) {
  return kit.place("backpack", parent, at, "backpack_" + canvas, [&](MeshDraft& draft) {
    const int cloth = kit.material(canvas), trim = kit.material("leather_brown"), strap = kit.material("black_plastic");
    draft.add(cloth, bevelled_box(0.31, 0.17, 0.44, 0.055).move(0, 0, 0.22));
    draft.add(cloth, bevelled_box(0.24, 0.07, 0.22, 0.028).move(0, -0.105, 0.15));
    draft.add(trim, bevelled_box(0.25, 0.075, 0.035, 0.012).move(0, -0.106, 0.265));
    draft.add(trim, bevelled_box(0.312, 0.172, 0.05, 0.02).move(0, 0, 0.03));
    for (const double side : {-1.0, 1.0}) {
      draft.add(trim, bevelled_box(0.022, 0.008, 0.15, 0.003).move(side * 0.07, -0.143, 0.23));
      draft.add(
          strap,
          tube(smooth_path({{side * 0.09, 0.075, 0.40}, {side * 0.10, 0.115, 0.36}, {side * 0.11, 0.13, 0.24}, {side * 0.12, 0.085, 0.06}},
                           5),
               0.012, 8));
    }
    draft.add(strap, tube(smooth_path({{-0.04, 0.06, 0.43}, {-0.03, 0.06, 0.48}, {0.03, 0.06, 0.48}, {0.04, 0.06, 0.43}}, 5), 0.008, 8));
  });
}

int add_shopping_bag(Kit& kit, int parent, const Placement& at) {
  return kit.place("shopping_bag", parent, at, "shopping_bag", [&](MeshDraft& draft) {
    constexpr double kWide = 0.33, kDeep = 0.19, kHigh = 0.34, kSheet = 0.003;
    const int paper = kit.material("kraft_paper");
    draft.add(paper, standing_box(kWide, kDeep, kSheet));
    for (const double side : {-1.0, 1.0}) {
      draft.add(paper, standing_box(kWide, kSheet, kHigh).move(0, side * (kDeep - kSheet) / 2, 0));
      draft.add(paper, standing_box(kSheet, kDeep - 2 * kSheet, kHigh).move(side * (kWide - kSheet) / 2, 0, 0));
      draft.add(
          kit.material("bin_red"),
          tube(smooth_path(
                   {{-0.07, side * 0.091, 0.30}, {-0.06, side * 0.088, 0.39}, {0.06, side * 0.088, 0.39}, {0.07, side * 0.091, 0.30}}, 5),
               0.004, 6));
    }
    draft.add(kit.material("bin_red"), rectangle({-0.09, -kDeep / 2 - 0.0008, 0.10}, {0.18, 0, 0}, {0, 0, 0.11}));
    // What was bought: a loaf, two cartons, something green.
    draft.add(kit.material("bread"), bevelled_box(0.10, 0.09, 0.36, 0.035).move(-0.09, 0.02, 0.19));
    draft.add(kit.material("linen_white"), standing_box(0.08, 0.08, 0.25, 0.004).move(0.02, -0.03, 0.06));
    draft.add(kit.material("bin_blue"), standing_box(0.07, 0.05, 0.27, 0.004).move(0.11, 0.03, 0.05));
    for (const double x : {-0.02, 0.01, 0.035}) {
      draft.add(kit.material("leaf"), cylinder({x, 0.05, 0.10}, {1.6 * x, 0.055, 0.40}, 0.011, 8));
    }
  });
}

int add_handbag(Kit& kit, int parent, const Placement& at, const std::string& leather) {
  return kit.place("handbag", parent, at, "handbag_" + leather, [&](MeshDraft& draft) {
    const int hide = kit.material(leather), metal = kit.material("chrome");
    draft.add(hide, extruded({{-0.075, 0}, {0.075, 0}, {0.072, 0.05}, {0.03, 0.25}, {-0.03, 0.25}, {-0.072, 0.05}}, 0.36));
    draft.add(hide, bevelled_box(0.30, 0.075, 0.022, 0.006).move(0, 0, 0.256));
    draft.add(metal, bevelled_box(0.04, 0.012, 0.02, 0.003).move(0, -0.042, 0.225));
    for (const double side : {-1.0, 1.0}) {
      draft.add(hide, tube(smooth_path({{-0.09, side * 0.028, 0.24},
                                        {-0.075, side * 0.022, 0.34},
                                        {0, side * 0.018, 0.39},
                                        {0.075, side * 0.022, 0.34},
                                        {0.09, side * 0.028, 0.24}},
                                       4),
                           0.007, 8));
    }
  });
}

}  // namespace waretwin::builder
