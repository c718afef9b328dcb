#include "scenes/builder/parts/beds_and_seats.h"

#include <algorithm>
#include <cmath>

namespace waretwin::builder {

Shape pillow(double dx, double dy, double dz) {
  constexpr int kCells = 8;
  const auto height = [&](double u, double v) {  // of one half; u, v from -1 to 1
    return 0.5 * dz * std::sqrt(std::max(0.0, (1 - u * u * u * u) * (1 - v * v * v * v)));
  };
  Shape s;
  for (const double side : {-1.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(s.positions.size());
    for (int i = 0; i <= kCells; ++i) {
      for (int k = 0; k <= kCells; ++k) {
        // Nearer together at the rim, where it is round.
        const auto spread = [](int n) {
          const double t = 2.0 * n / kCells - 1;
          return t * (1.35 - 0.35 * t * t);
        };
        const double u = spread(i), v = spread(k), step = 1e-3;
        const auto inside = [](double t) { return std::clamp(t, -0.995, 0.995); };
        const double slope_x = (height(inside(u + step), v) - height(inside(u - step), v)) / (step * dx),
                     slope_y = (height(u, inside(v + step)) - height(u, inside(v - step))) / (step * dy);
        s.positions.emplace_back(u * dx / 2, v * dy / 2, side * height(u, v) + dz / 2);
        s.normals.push_back(Vector3d(-slope_x, -slope_y, 1).normalized().cwiseProduct(Vector3d(1, 1, side)));
        s.uv.emplace_back((u + 1) * dx / 2, (1 - v) * dy / 2);
      }
    }
    for (int i = 0; i < kCells; ++i) {
      for (int k = 0; k < kCells; ++k) {
        const auto at = [&](int di, int dk) { return first + static_cast<std::uint32_t>((i + di) * (kCells + 1) + k + dk); };
        if (side > 0) {
          s.triangles.insert(s.triangles.end(), {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
        } else {
          s.triangles.insert(s.triangles.end(), {at(0, 0), at(1, 1), at(1, 0), at(0, 0), at(0, 1), at(1, 1)});
        }
      }
    }
  }
  return s;
}

int add_bed(Kit& kit, int parent, const Placement& at, const Bed& b) {
  const std::string name = "bed_" + in_mm({b.length, b.width, b.headboard}) + b.frame + b.linen + b.blanket;
  return kit.place("bed", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kBoard = 0.05, kRailTop = 0.32, kMattressTop = 0.50;
    const int frame = kit.material(b.frame), linen = kit.material(b.linen), blanket = kit.material(b.blanket);
    const double head = b.length / 2, foot = -b.length / 2, inside = b.length - 2 * kBoard;
    draft.add(frame, standing_box(b.width, kBoard, b.headboard, 0.008).move(0, head - kBoard / 2, 0));
    draft.add(frame, standing_box(b.width, kBoard, 0.38, 0.008).move(0, foot + kBoard / 2, 0));
    for (const double side : {-1.0, 1.0})
      draft.add(frame, standing_box(0.03, inside, kRailTop - 0.14).move(side * (b.width / 2 - 0.015), 0, 0.14));
    draft.add(linen, standing_box(b.width - 0.07, inside - 0.05, kMattressTop - 0.22, 0.035).move(0, 0, 0.22));
    // The blanket hangs over both sides and ends below the pillows, with the sheet folded back over its edge.
    const double covered = 0.68 * inside, from = foot + kBoard + 0.005;
    draft.add(blanket, bevelled_box(b.width - 0.035, covered, 0.20, 0.045).move(0, from + covered / 2, kMattressTop - 0.06));
    draft.add(linen, bevelled_box(b.width - 0.03, 0.20, 0.20, 0.045).move(0, from + covered - 0.06, kMattressTop - 0.055));
    const int pillows = b.width > 1.25 ? 2 : 1;
    const double wide = std::min(0.70, (b.width - 0.12) / pillows);
    for (int i = 0; i < pillows; ++i) {
      const double x = (i - 0.5 * (pillows - 1)) * (b.width - 0.06) / pillows;
      // Leaning a little against the headboard.
      Shape p = pillow(wide, 0.42, 0.17).rotate(Vector3d::UnitX(), 14).rotate(Vector3d::UnitZ(), i == 0 ? 3 : -4);
      draft.add(linen, p.move(x, head - kBoard - 0.24, kMattressTop + 0.03));
    }
  });
}

int add_wooden_chair(Kit& kit, int parent, const Placement& at, const WoodenChair& c) {
  const std::string name = "wooden_chair_" + in_mm({c.width, c.depth, c.seat, c.height}) + c.wood + c.cushion;
  return kit.place("wooden_chair", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kPost = 0.036, kLean = 7;  // degrees that the back leans
    const int wood = kit.material(c.wood);
    const double x = c.width / 2 - kPost / 2, y = c.depth / 2 - kPost / 2;
    for (const double side : {-1.0, 1.0}) {
      draft.add(wood, standing_box(kPost, kPost, c.seat - 0.02, 0.004).move(side * x, -y, 0));
      draft.add(wood, standing_box(kPost, kPost, c.seat, 0.004).move(side * x, y, 0));
      Shape post = standing_box(kPost, kPost, c.height - c.seat + 0.005, 0.004);
      draft.add(wood, post.rotate(Vector3d::UnitX(), -kLean).move(side * x, y, c.seat - 0.01));
      draft.add(wood, standing_box(0.02, c.depth - 2 * kPost, 0.035).move(side * x, 0, 0.20));
      draft.add(wood, standing_box(0.02, c.depth - 2 * kPost, 0.05).move(side * x, 0, c.seat - 0.075));
    }
    for (const double side : {-1.0, 1.0}) draft.add(wood, standing_box(c.width - 2 * kPost, 0.02, 0.05).move(0, side * y, c.seat - 0.075));
    draft.add(wood, standing_box(c.width - 0.005, c.depth - kPost, 0.024, 0.006).move(0, -kPost / 2, c.seat - 0.024));
    const double back = c.height - c.seat;
    for (const double share : {0.36, 0.60, 0.86}) {
      Shape slat = bevelled_box(c.width - 2 * kPost + 0.01, 0.018, share > 0.8 ? 0.075 : 0.05, 0.004).move(0, 0, share * back);
      draft.add(wood, slat.rotate(Vector3d::UnitX(), -kLean).move(0, y, c.seat - 0.01));
    }
    if (!c.cushion.empty()) draft.add(kit.material(c.cushion), pillow(c.width - 0.05, c.depth - 0.07, 0.05).move(0, -kPost / 2, c.seat));
  });
}

int add_sofa(Kit& kit, int parent, const Placement& at, const Sofa& s) {
  const std::string name =
      "sofa_" + in_mm({s.width, s.depth, s.height}) + "_" + std::to_string(s.seats) + s.fabric + (s.cushions ? s.cushion : "");
  return kit.place(s.seats == 1 ? "armchair" : "sofa", parent, at, name, [&](MeshDraft& draft) {
    constexpr double kFoot = 0.09, kBase = 0.29, kArm = 0.17, kArmTop = 0.60, kBack = 0.20, kSeat = 0.45;
    const int cloth = kit.material(s.fabric), feet = kit.material("walnut");
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0})
        draft.add(feet, standing_box(0.05, 0.05, kFoot + 0.005).move(sx * (s.width / 2 - 0.07), sy * (s.depth / 2 - 0.07), 0));
      draft.add(cloth, bevelled_box(kArm, s.depth, kArmTop - kFoot, 0.045).move(sx * (s.width - kArm) / 2, 0, (kArmTop + kFoot) / 2));
    }
    const double inside = s.width - 2 * kArm;
    draft.add(cloth, bevelled_box(inside + 0.01, s.depth - 0.03, kBase - kFoot, 0.01).move(0, 0, (kBase + kFoot) / 2));
    draft.add(cloth, bevelled_box(inside + 0.01, kBack, s.height - kFoot, 0.05).move(0, (s.depth - kBack) / 2, (s.height + kFoot) / 2));
    const double each = inside / s.seats, depth = s.depth - kBack - 0.01;
    for (int i = 0; i < s.seats; ++i) {
      const double x = (i - 0.5 * (s.seats - 1)) * each;
      draft.add(cloth,
                bevelled_box(each - 0.008, depth, kSeat - kBase, 0.035).move(x, -(s.depth - depth) / 2 + 0.008, (kSeat + kBase) / 2));
      Shape back = bevelled_box(each - 0.012, 0.15, s.height - kSeat - 0.03, 0.05).rotate(Vector3d::UnitX(), -9);
      draft.add(cloth, back.move(x, (s.depth) / 2 - kBack - 0.055, 0.5 * (s.height + kSeat) - 0.01));
    }
    if (!s.cushions) return;
    const int cushion = kit.material(s.cushion);
    for (const double side : {-1.0, 1.0}) {
      if (side > 0 && s.seats == 1) continue;
      Shape p = pillow(0.42, 0.42, 0.15).move(0, 0, -0.075).rotate(Vector3d::UnitX(), 68).rotate(Vector3d::UnitZ(), side * -16);
      draft.add(cushion, p.move(s.seats == 1 ? 0 : side * (inside / 2 - 0.24), s.depth / 2 - kBack - 0.26, kSeat + 0.20));
    }
  });
}

}  // namespace waretwin::builder
