#include "scenes/builder/parts/books.h"

#include <algorithm>

#include "core/random.h"

namespace waretwin::builder {
namespace {

std::string cover(double draw) { return "cover_" + std::to_string(1 + static_cast<int>(draw * 7)); }

// A closed book with its back to -y, standing on z = 0: two boards, a back, the pages between them a little smaller.
void add_book(Kit& kit, MeshDraft& draft, const std::string& finish, double thickness, double depth, double height,
              const Eigen::Isometry3d& X) {
  constexpr double kBoard = 0.003;
  const int board = kit.material(finish);
  for (const double side : {-1.0, 1.0})
    draft.add(board, standing_box(kBoard, depth, height).move(side * (thickness - kBoard) / 2, 0, 0).transform(X));
  draft.add(board, standing_box(thickness, kBoard, height).move(0, -(depth - kBoard) / 2, 0).transform(X));
  draft.add(kit.material("paper"), standing_box(thickness - 2 * kBoard, depth - 0.008, height - 0.008).move(0, 0, 0.004).transform(X));
  // A line of print across the back.
  if (thickness > 0.024) {
    draft.add(kit.material(finish == "cover_4" ? "cover_6" : "cover_4"),
              standing_box(thickness - 0.008, 0.001, 0.03).move(0, -depth / 2 - 0.0003, height * 0.72).transform(X));
  }
}

}  // namespace

int add_book_row(Kit& kit, int parent, const Placement& at, double length, double height, const std::string& key) {
  return kit.place("books", parent, at, "book_row_" + in_mm({length, height}) + key, [&](MeshDraft& draft) {
    const RandomStream random(0, "book row", key);
    double x = -length / 2;
    for (std::uint64_t i = 0;; ++i) {
      const double thick = 0.018 + 0.032 * random.uniform(i, 0);
      if (x + thick > length / 2) break;
      const double high = height * (0.74 + 0.26 * random.uniform(i, 1)), deep = 0.15 + 0.05 * random.uniform(i, 2);
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      X.translation() = Vector3d(x + thick / 2, -0.1 + deep / 2, 0);
      add_book(kit, draft, cover(random.uniform(i, 3)), thick, deep, high, X);
      x += thick + 0.001;
    }
  });
}

int add_book_pile(Kit& kit, int parent, const Placement& at, int count, const std::string& key) {
  return kit.place("books", parent, at, "book_pile_" + std::to_string(count) + key, [&](MeshDraft& draft) {
    const RandomStream random(0, "book pile", key);
    double z = 0;
    for (int i = 0; i < count; ++i) {
      const auto n = static_cast<std::uint64_t>(i);
      const double thick = 0.020 + 0.022 * random.uniform(n, 0), share = 1 - 0.25 * i / std::max(1, count - 1);
      const double high = share * (0.27 + 0.03 * random.uniform(n, 1)), deep = share * (0.19 + 0.02 * random.uniform(n, 2));
      // Lying: what was up is now along x, what was the thickness is up.
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      X.linear() =
          (Eigen::AngleAxisd((0.28 * random.uniform(n, 4) - 0.14), Vector3d::UnitZ()) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()))
              .toRotationMatrix();
      X.translation() = X.linear() * Vector3d(0, 0, -high / 2) + Vector3d(0, 0, z + thick / 2);
      add_book(kit, draft, cover(random.uniform(n, 3)), thick, deep, high, X);
      z += thick + 0.0005;
    }
  });
}

}  // namespace waretwin::builder
