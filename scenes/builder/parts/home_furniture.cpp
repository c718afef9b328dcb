#include "scenes/builder/parts/home_furniture.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"
#include "core/random.h"

namespace waretwin::builder {
namespace {

// A front with a handle bar across it, its outer side at y = 0.
void add_front(Kit& kit, MeshDraft& draft, const std::string& finish, double x, double z, double width, double height, bool upright,
               double handle_x, double handle_z) {
  constexpr double kThick = 0.018;
  draft.add(kit.material(finish), standing_box(width, kThick, height, 0.003).move(x, kThick / 2, z));
  const double long_side = 0.14, bar = 0.012;
  draft.add(kit.material("steel"),
            bevelled_box(upright ? bar : long_side, 0.022, upright ? long_side : bar, 0.003).move(handle_x, -0.008, handle_z));
}

}  // namespace

int add_wooden_table(Kit& kit, int parent, const Placement& at, const WoodenTable& t) {
  const std::string name =
      "wooden_table_" + in_mm({t.width, t.depth, t.height}) + t.wood + (t.shelf ? "_shelf" : "") + (t.drawers ? "_drawers" : "");
  return kit.place("table", parent, at, name, [&](MeshDraft& draft) {
    const int wood = kit.material(t.wood);
    const double top = 0.032, leg = t.height < 0.55 ? 0.05 : 0.065, x = t.width / 2 - 0.03 - leg / 2, y = t.depth / 2 - 0.03 - leg / 2;
    draft.add(wood, standing_box(t.width, t.depth, top, 0.004).move(0, 0, t.height - top));
    const double apron = t.height < 0.55 ? 0.05 : 0.08;
    for (const double side : {-1.0, 1.0}) {
      for (const double front : {-1.0, 1.0}) draft.add(wood, standing_box(leg, leg, t.height - top, 0.003).move(side * x, front * y, 0));
      draft.add(wood, standing_box(2 * x - leg, 0.02, apron).move(0, side * y, t.height - top - apron));
      draft.add(wood, standing_box(0.02, 2 * y - leg, apron).move(side * x, 0, t.height - top - apron));
    }
    if (t.shelf) draft.add(wood, standing_box(2 * x, 2 * y, 0.018).move(0, 0, 0.13));
    if (!t.drawers) return;
    const double wide = 0.38, deep = t.depth - 0.12, low = 0.16, high = t.height - top - apron - 0.002;
    const double middle = x - leg / 2 - wide / 2 - 0.003;
    draft.add(wood, standing_box(wide, deep, high - low).move(middle, 0.02, low));
    MeshDraft fronts;
    for (int i = 0; i < 3; ++i) {
      const double h = (high - low) / 3 - 0.006, z = low + 0.003 + i * (high - low) / 3;
      add_front(kit, fronts, t.wood, middle, z, wide - 0.008, h, false, middle, z + h - 0.035);
    }
    for (auto [material, shape] : fronts.parts()) draft.add(material, shape.move(0, 0.02 - deep / 2 - 0.018, 0));
  });
}

int add_chest(Kit& kit, int parent, const Placement& at, const Chest& c) {
  const std::string name =
      "chest_" + in_mm({c.width, c.depth, c.height}) + std::to_string(c.columns) + "_" + std::to_string(c.rows) + c.body + c.front;
  return kit.place("chest", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kFoot = 0.06, kTop = 0.022;
    const int body = kit.material(c.body);
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0})
        draft.add(body, standing_box(0.04, 0.04, kFoot + 0.005).move(sx * (c.width / 2 - 0.035), sy * (c.depth / 2 - 0.04), 0));
    }
    draft.add(body, standing_box(c.width - 0.01, c.depth - 0.03, c.height - kFoot - kTop, 0.003).move(0, 0.01, kFoot));
    draft.add(body, standing_box(c.width, c.depth, kTop, 0.004).move(0, 0, c.height - kTop));
    MeshDraft fronts;
    const double w = (c.width - 0.03) / c.columns, h = (c.height - kFoot - kTop - 0.012) / c.rows;
    for (int i = 0; i < c.columns; ++i) {
      for (int k = 0; k < c.rows; ++k) {
        const double x = (i - 0.5 * (c.columns - 1)) * w, z = kFoot + 0.008 + k * h;
        add_front(kit, fronts, c.front, x, z, w - 0.008, h - 0.008, false, x, z + 0.6 * h);
      }
    }
    for (auto [material, shape] : fronts.parts()) draft.add(material, shape.move(0, 0.01 - (c.depth - 0.03) / 2 - 0.012, 0));
  });
}

int add_wardrobe(Kit& kit, int parent, const Placement& at, const Wardrobe& w) {
  const std::string name = "wardrobe_" + in_mm({w.width, w.depth, w.height}) + w.body + w.front;
  return kit.place("wardrobe", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kPlinth = 0.08;
    draft.add(kit.material(w.body), standing_box(w.width, w.depth - 0.02, w.height, 0.004).move(0, 0.01, 0));
    const int doors = std::max(2, static_cast<int>(std::lround(w.width / 0.5)));
    const double each = (w.width - 0.02) / doors;
    MeshDraft fronts;
    for (int i = 0; i < doors; ++i) {
      const double x = (i - 0.5 * (doors - 1)) * each, handle = x + (i % 2 == 0 ? 1 : -1) * (each / 2 - 0.05);
      add_front(kit, fronts, w.front, x, kPlinth, each - 0.006, w.height - kPlinth - 0.02, true, handle, 1.02);
    }
    for (auto [material, shape] : fronts.parts()) draft.add(material, shape.move(0, -w.depth / 2 + 0.004, 0));
  });
}

int add_bookcase(Kit& kit, int parent, const Placement& at, const Bookcase& b) {
  const std::string name = "bookcase_" + in_mm({b.width, b.depth, b.height}) + std::to_string(b.boards) + b.wood;
  return kit.place("bookcase", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kBoard = 0.02;
    const int wood = kit.material(b.wood);
    for (const double side : {-1.0, 1.0})
      draft.add(wood, standing_box(kBoard, b.depth, b.height - kBoard).move(side * (b.width - kBoard) / 2, 0, 0));
    draft.add(wood, standing_box(b.width - 2 * kBoard, 0.008, b.height - kBoard).move(0, b.depth / 2 - 0.004, 0));
    for (int i = 0; i + 1 < b.boards; ++i)
      draft.add(wood, standing_box(b.width - 2 * kBoard, b.depth - 0.008, kBoard).move(0, -0.004, b.board_top(i) - kBoard));
    draft.add(wood, standing_box(b.width, b.depth, kBoard, 0.003).move(0, 0, b.height - kBoard));
    draft.add(wood, standing_box(b.width - 2 * kBoard, 0.02, 0.06).move(0, -b.depth / 2 + 0.03, 0));
  });
}

int add_television(Kit& kit, int parent, const Placement& at, double width, const std::string& picture_finish) {
  return kit.place("television", parent, at, "television_" + picture_finish + in_mm({width}), [&](MeshDraft& draft) {
    const double w = width - 0.02, h = w * 9 / 16, low = 0.07;
    const int black = kit.material("black_plastic");
    for (const double side : {-1.0, 1.0}) {
      const double x = side * width * 0.36;
      draft.add(black, standing_box(0.03, 0.22, 0.012, 0.003).move(x, 0, 0));
      draft.add(black, standing_box(0.024, 0.03, low).move(x, 0.01, 0.008));
    }
    draft.add(black, standing_box(width, 0.03, h + 0.022, 0.004).move(0, -0.005, low));
    draft.add(black, standing_box(width * 0.6, 0.05, h * 0.55, 0.01).move(0, 0.035, low + 0.04));
    draft.add(kit.material(picture_finish), picture({-w / 2, -0.0206, low + 0.012}, {w, 0, 0}, {0, 0, h}));
  });
}

int add_fruit_bowl(Kit& kit, int parent, const Placement& at) {
  return kit.place("fruit_bowl", parent, at, "fruit_bowl", [&](MeshDraft& draft) {
    draft.add(kit.material("ceramic"),
              turned({{0, 0}, {0.06, 0}, {0.06, 0.01}, {0.13, 0.06}, {0.15, 0.085}, {0.142, 0.085}, {0.12, 0.06}, {0, 0.02}}, 24));
    const char* kinds[] = {"fruit_red", "fruit_green", "fruit_orange"};
    constexpr double kRadius = 0.036;
    Profile ball;
    for (int k = 0; k <= 8; ++k) ball.emplace_back(k % 8 == 0 ? 0 : kRadius * std::sin(M_PI * k / 8), -kRadius * std::cos(M_PI * k / 8));
    for (int i = 0; i < 6; ++i) {
      const double a = to_radians(72 * i), r = i < 5 ? 0.068 : 0, z = i < 5 ? 0.076 : 0.115;
      draft.add(kit.material(kinds[i % 3]), turned(ball, 12).move(r * std::cos(a), r * std::sin(a), z));
    }
  });
}

int add_vase(Kit& kit, int parent, const Placement& at) {
  return kit.place("vase", parent, at, "vase", [&](MeshDraft& draft) {
    draft.add(kit.material("fabric_rust"),
              turned({{0, 0}, {0.05, 0}, {0.075, 0.07}, {0.06, 0.16}, {0.032, 0.21}, {0.04, 0.24}, {0, 0.235}}, 20));
    const RandomStream random(0, "vase", "twigs");
    for (std::uint64_t i = 0; i < 7; ++i) {
      const double a = 2 * M_PI * random.uniform(i, 0), lean = 0.05 + 0.09 * random.uniform(i, 1),
                   high = 0.40 + 0.16 * random.uniform(i, 2);
      const Vector3d tip(lean * std::cos(a), lean * std::sin(a), high);
      draft.add(kit.material("leaf"), cylinder({0, 0, 0.22}, tip, 0.004, 5));
      draft.add(kit.material(i % 2 == 0 ? "fruit_orange" : "linen_white"),
                turned({{0, -0.02}, {0.026, 0.0}, {0, 0.022}}, 8).move(tip.x(), tip.y(), tip.z()));
    }
  });
}

}  // namespace waretwin::builder
