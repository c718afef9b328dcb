#include "scenes/builder/parts/storage.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "scenes/builder/parts/furniture.h"

namespace waretwin::builder {

int add_pallet(Kit& kit, int parent, const Placement& at) {
  return kit.place("pallet", parent, at, "pallet", [&](MeshDraft& draft) {
    const int wood = kit.material("pallet_wood");
    const double deck[] = {-0.3275, -0.17, 0.0, 0.17, 0.3275};
    for (int i = 0; i < 5; ++i) draft.add(wood, standing_box(1.2, i % 2 == 0 ? 0.145 : 0.10, 0.022).move(0, deck[i], 0.122));
    for (const double x : {-0.5275, 0.0, 0.5275}) {
      draft.add(wood, standing_box(0.145, 0.8, 0.022).move(x, 0, 0.1));
      for (const double y : {-0.35, 0.0, 0.35}) draft.add(wood, standing_box(0.145, 0.10, 0.078).move(x, y, 0.022));
    }
    for (const double y : {-0.35, 0.0, 0.35}) draft.add(wood, standing_box(1.2, 0.10, 0.022).move(0, y, 0));
  });
}

int add_carton(Kit& kit, int parent, const Placement& at, double dx, double dy, double dz) {
  return kit.place("carton", parent, at, "carton_" + in_mm({dx, dy, dz}), [&](MeshDraft& draft) {
    draft.add(kit.material("cardboard"), standing_box(dx, dy, dz));
    draft.add(kit.material("packing_tape"), standing_box(dx + 0.001, 0.05, dz + 0.0008));
    draft.add(kit.material("label_parcel"), picture({dx * 0.1, -dy / 2 - 0.001, dz * 0.25}, {0.10, 0, 0}, {0, 0, 0.15}));
    draft.add(kit.material("label_parcel"), picture({-dx * 0.1, dy / 2 + 0.001, dz * 0.25}, {-0.10, 0, 0}, {0, 0, 0.15}));
  });
}

int add_carton_stack(Kit& kit, int parent, const Placement& at, int rows, int columns, int layers, double dx, double dy, double dz,
                     const std::string& key) {
  const int stack = kit.group("cartons", parent, at);
  const RandomStream random(0, "cartons", key);
  for (int k = 0; k < layers; ++k) {
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const auto n = static_cast<std::uint64_t>((k * rows + i) * columns + j);
        if (k == layers - 1 && layers > 1 && random.uniform(n, 0) < 0.2) continue;
        add_carton(kit, stack,
                   {(i - (rows - 1) / 2.0) * (dx + 0.012), (j - (columns - 1) / 2.0) * (dy + 0.012), k * dz,
                    1.6 * random.uniform(n, 1) - 0.8 + (random.uniform(n, 2) < 0.5 ? 180 : 0)},
                   dx, dy, dz);
      }
    }
  }
  return stack;
}

int add_loaded_pallet(Kit& kit, int parent, const Placement& at, int kind, const std::string& key) {
  const int node = kit.group("loaded_pallet", parent, at);
  add_pallet(kit, node, {});
  const Placement top{0, 0, kPalletHeight};
  if (kind == 0) {
    add_carton_stack(kit, node, top, 3, 2, 3, 0.38, 0.38, 0.30, key);
  } else if (kind == 1) {
    kit.place("wrapped_load", node, top, "wrapped_load", [&](MeshDraft& draft) {
      draft.add(kit.material("cardboard"), standing_box(1.14, 0.76, 1.0, 0.01));
      draft.add(kit.material("stretch_film"), standing_box(1.16, 0.78, 0.62, 0.012).move(0, 0, -0.01));
      draft.add(kit.material("label_parcel"), picture({0.2, -0.392, 0.35}, {0.14, 0, 0}, {0, 0, 0.21}));
    });
  } else if (kind == 2) {
    for (int layer = 0; layer < 3; ++layer) {
      for (const double x : {-0.40, 0.0, 0.40}) {
        for (const double y : {-0.2, 0.2}) {
          add_bin(kit, node, {x, y, kPalletHeight + 0.28 * layer}, 0.38, 0.38, 0.28, layer % 2 == 0 ? "bin_blue" : "bin_red");
        }
      }
    }
  } else {
    for (int i = 1; i < 6; ++i) add_pallet(kit, node, {0, 0.004 * (i % 3), i * kPalletHeight, 0.6 * (i % 2)});
  }
  return node;
}

int add_rack(Kit& kit, int parent, const Placement& at, const Rack& rack) {
  const double bay = 2.7, depth = 1.1, post = 0.09;
  const double height = rack.levels * rack.level_height + 0.9, length = rack.bays * bay + post;
  const int node = kit.group("rack", parent, at);
  const int upright = kit.mesh("rack_upright_" + in_mm({height}), [&](MeshDraft& draft) {
    for (const double y : {-depth / 2, depth / 2}) {
      draft.add(kit.material("blue_paint"), standing_box(post, 0.08, height).move(0, y, 0));
      draft.add(kit.material("galvanised"), standing_box(0.14, 0.14, 0.01).move(0, y, 0));
    }
    const int braces = static_cast<int>(height / 0.9);
    for (int i = 0; i < braces; ++i) {
      const double z = 0.2 + i * 0.9, side = i % 2 == 0 ? 1 : -1;
      draft.add(kit.material("blue_paint"), cylinder({0, -side * depth / 2, z}, {0, side * depth / 2, z + 0.75}, 0.02, 6));
    }
    draft.add(kit.material("yellow_paint"), standing_box(0.14, 0.05, 0.4).move(0, -depth / 2 - 0.07, 0));
  });
  const int beam = kit.mesh("rack_beam", [&](MeshDraft& draft) {
    for (const double y : {-depth / 2, depth / 2})
      draft.add(kit.material("orange_paint"), standing_box(bay - post, 0.05, 0.12).move(0, y, -0.12));
    for (const double x : {-0.9, -0.3, 0.3, 0.9})
      draft.add(kit.material("galvanised"), standing_box(0.10, depth - 0.05, 0.03).move(x, 0, -0.032));
    draft.add(kit.material("label_type"), picture({-0.1, -depth / 2 - 0.026, -0.09}, {0.12, 0, 0}, {0, 0, 0.06}));
  });
  for (int i = 0; i <= rack.bays; ++i) kit.model.add_node("rack_upright", node, Placement{i * bay - (length - post) / 2, 0, 0}, upright);
  const RandomStream random(0, "rack", rack.key);
  for (int i = 0; i < rack.bays; ++i) {
    const double x = (i + 0.5) * bay - (length - post) / 2;
    for (int level = 0; level <= rack.levels; ++level) {
      const double z = level * rack.level_height + 0.001;
      if (level > 0) kit.model.add_node("rack_beam", node, Placement{x, 0, level * rack.level_height}, beam);
      for (int slot = 0; slot < 3; ++slot) {
        const auto n = static_cast<std::uint64_t>((i * 16 + level) * 3 + slot);
        if (random.uniform(n, 0) > rack.fill) continue;
        const double kinds = random.uniform(n, 1);
        const int kind = kinds < 0.42 ? 0 : kinds < 0.78 ? 1 : kinds < 0.92 ? 2 : 3;
        add_loaded_pallet(kit, node, {x + (slot - 1) * 0.86, 0.02 * random.uniform(n, 2), z, 90 + 2 * random.uniform(n, 3) - 1}, kind,
                          rack.key + std::to_string(n % 5));
      }
    }
  }
  return node;
}

int add_barrier(Kit& kit, int parent, const Placement& at, double length) {
  return kit.place("barrier", parent, at, "barrier_" + in_mm({length}), [&](MeshDraft& draft) {
    const int posts = std::max(2, static_cast<int>(length / 1.5) + 1);
    for (int i = 0; i < posts; ++i) {
      const double x = (i / (posts - 1.0) - 0.5) * (length - 0.1);
      draft.add(kit.material("yellow_paint"), standing_box(0.09, 0.09, 0.62).move(x, 0, 0));
      draft.add(kit.material("dark_steel"), standing_box(0.18, 0.18, 0.012).move(x, 0, 0));
    }
    for (const double z : {0.20, 0.46}) draft.add(kit.material("hazard_tape"), standing_box(length, 0.05, 0.12).move(0, -0.06, z));
  });
}

int add_post(Kit& kit, int parent, const Placement& at) {
  return kit.place("post", parent, at, "post", [&](MeshDraft& draft) {
    draft.add(kit.material("dark_steel"), standing_box(0.2, 0.2, 0.012));
    for (int i = 0; i < 5; ++i) {
      draft.add(kit.material(i % 2 == 0 ? "yellow_paint" : "black_paint"),
                cylinder({0, 0, 0.01 + 0.18 * i}, {0, 0, 0.19 + 0.18 * i}, 0.057, 16, i == 4));
    }
  });
}

int add_column(Kit& kit, int parent, const Placement& at, double height) {
  return kit.place("column", parent, at, "column_" + in_mm({height}), [&](MeshDraft& draft) {
    const double w = 0.15, t = 0.014;
    const Profile section = {{-w, -w}, {w, -w}, {w, -w + t}, {t, -w + t}, {t, w - t},   {w, w - t},
                             {w, w},   {-w, w}, {-w, w - t}, {-t, w - t}, {-t, -w + t}, {-w, -w + t}};
    draft.add(kit.material("light_grey_paint"), extruded(section, height).rotate(Vector3d::UnitY(), -90).move(0, 0, height / 2));
    draft.add(kit.material("hazard_tape"), standing_box(0.42, 0.42, 0.5, 0.02));
  });
}

int add_fence(Kit& kit, int parent, const Placement& at, double length) {
  return kit.place("fence", parent, at, "fence_" + in_mm({length}), [&](MeshDraft& draft) {
    const int panels = std::max(1, static_cast<int>(std::ceil(length / 1.5)));
    for (int i = 0; i <= panels; ++i)
      draft.add(kit.material("yellow_paint"), standing_box(0.05, 0.05, 1.8).move((static_cast<double>(i) / panels - 0.5) * length, 0, 0));
    draft.add(kit.material("mesh_fence"), rectangle({-length / 2, 0, 0.15}, {length, 0, 0}, {0, 0, 1.6}));
    for (const double z : {0.12, 1.74}) draft.add(kit.material("black_paint"), standing_box(length, 0.03, 0.03).move(0, 0, z));
  });
}

int add_hanging_sign(Kit& kit, int parent, const Placement& at, int number) {
  const std::string n = std::to_string(number);
  return kit.place("sign_" + n, parent, at, "hanging_sign_" + n, [&](MeshDraft& draft) {
    draft.add(kit.material("grey_plastic"), standing_box(0.8, 0.02, 0.8));
    draft.add(kit.material("marker_" + n), picture({-0.39, -0.011, 0.01}, {0.78, 0, 0}, {0, 0, 0.78}));
    draft.add(kit.material("marker_" + n), picture({0.39, 0.011, 0.01}, {-0.78, 0, 0}, {0, 0, 0.78}));
  });
}

}  // namespace waretwin::builder
