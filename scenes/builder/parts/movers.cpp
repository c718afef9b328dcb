#include "scenes/builder/parts/movers.h"

#include <algorithm>

#include "core/error.h"
#include "scenes/builder/parts/storage.h"

namespace waretwin::builder {
namespace {

// A limb: a tube that tapers from one joint to the next, round at both.
Shape limb(const Vector3d& from, const Vector3d& to, double thick, double thin) {
  const Vector3d way = to - from;
  Shape shape = turned({{0, -0.5 * thick},
                        {0.75 * thick, -0.3 * thick},
                        {thick, 0},
                        {thin, way.norm()},
                        {0.6 * thin, way.norm() + 0.4 * thin},
                        {0, way.norm() + 0.5 * thin}},
                       14);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), way).toRotationMatrix();
  X.translation() = from;
  return shape.transform(X);
}

// A ring of an oval cross-section, from bottom to top.
struct Ring {
  double z, half_x, half_y;
};

// A body whose cross-sections are ovals.
Shape oval_body(const std::vector<Ring>& rings, int sides) {
  Profile unit;
  for (const Ring& ring : rings) unit.emplace_back(1.0, ring.z);
  unit.insert(unit.begin(), {0.0, rings.front().z});
  unit.emplace_back(0.0, rings.back().z);
  Shape shape = turned(unit, sides);
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    Vector3d& p = shape.positions[i];
    // Between the rings around it.
    std::size_t above = 1;
    while (above + 1 < rings.size() && rings[above].z < p.z()) ++above;
    const Ring &low = rings[above - 1], &high = rings[above];
    const double share = std::clamp((p.z() - low.z) / (high.z - low.z), 0.0, 1.0);
    const double half_x = low.half_x + share * (high.half_x - low.half_x), half_y = low.half_y + share * (high.half_y - low.half_y);
    p.x() *= half_x;
    p.y() *= half_y;
    Vector3d& n = shape.normals[i];
    n.x() /= half_x;
    n.y() /= half_y;
    n.normalize();
  }
  return shape;
}

}  // namespace

int add_tote(Kit& kit, int parent, const Placement& at) {
  return kit.place("tote", parent, at, "tote", [&](MeshDraft& draft) {
    const int blue = kit.material("bin_blue");
    draft.add(blue, standing_box(0.37, 0.27, 0.18, 0.008));
    draft.add(blue, standing_box(0.40, 0.30, 0.02, 0.004).move(0, 0, 0.15));
    draft.add(kit.material("grey_plastic"), standing_box(0.39, 0.29, 0.03, 0.006).move(0, 0, 0.17));
    for (const double side : {-1.0, 1.0}) {
      draft.add(kit.material("black_plastic"), bevelled_box(0.012, 0.10, 0.03, 0.004).move(side * 0.19, 0, 0.11));
      draft.add(kit.material("label_parcel"), picture({-side * 0.05, side * -0.1362, 0.02}, {side * 0.08, 0, 0}, {0, 0, 0.12}));
    }
  });
}

int add_person(Kit& kit, int parent, const Placement& at) {
  return kit.place("person", parent, at, "person", [&](MeshDraft& draft) {
    const int trousers = kit.material("fabric_blue"), vest = kit.material("orange_paint"), shirt = kit.material("fabric_black");
    const int skin = kit.material("skin"), shoe = kit.material("rubber"), stripe = kit.material("reflective_stripe");
    // In stride: the left leg in front, the right arm with it.
    for (const double side : {1.0, -1.0}) {
      const double step = side * 0.24, y = side * 0.09;
      const Vector3d hip(0, y, 0.90), knee(0.55 * step + 0.04, y, 0.49), ankle(step, y, side > 0 ? 0.09 : 0.12);
      draft.add(trousers, limb(hip, knee, 0.085, 0.060));
      draft.add(trousers, limb(knee, ankle, 0.062, 0.042));
      draft.add(
          shoe,
          bevelled_box(0.27, 0.10, 0.09, 0.02).rotate(Vector3d::UnitY(), side > 0 ? -6 : 14).move(step + 0.06, y, side > 0 ? 0.05 : 0.06));
      const Vector3d shoulder(0, side * 0.20, 1.42), elbow(-0.10 * side, side * 0.25, 1.14), hand(0.18 - 0.22 * side, side * 0.22, 0.95);
      draft.add(shirt, limb(shoulder, elbow, 0.055, 0.042));
      draft.add(shirt, limb(elbow, hand, 0.042, 0.032));
      draft.add(skin, limb(hand, hand + Vector3d(0.03, 0, -0.09), 0.036, 0.028));
    }
    draft.add(trousers, oval_body({{0.84, 0.10, 0.15}, {0.92, 0.12, 0.17}, {1.00, 0.11, 0.155}}, 24));
    draft.add(vest, oval_body({{0.96, 0.12, 0.17}, {1.10, 0.12, 0.175}, {1.30, 0.13, 0.195}, {1.42, 0.11, 0.20}, {1.47, 0.07, 0.11}}, 24));
    for (const double z : {1.08, 1.22}) {
      const double half_x = z < 1.1 ? 0.122 : 0.128, half_y = z < 1.1 ? 0.177 : 0.190;
      draft.add(stripe, oval_body({{z, half_x, half_y}, {z + 0.05, half_x + 0.002, half_y + 0.003}}, 24));
    }
    draft.add(skin, limb({0, 0, 1.45}, {0.01, 0, 1.54}, 0.055, 0.05));
    draft.add(skin, oval_body({{1.52, 0.06, 0.05}, {1.57, 0.095, 0.07}, {1.65, 0.105, 0.08}, {1.72, 0.09, 0.07}, {1.75, 0.04, 0.03}}, 20));
    draft.add(kit.material("yellow_paint"),
              oval_body({{1.645, 0.135, 0.10}, {1.66, 0.125, 0.095}, {1.70, 0.115, 0.09}, {1.75, 0.075, 0.06}, {1.765, 0.02, 0.02}}, 20));
  });
}

int add_cart(Kit& kit, int parent, const Placement& at) {
  const int node = kit.group("cart", parent, at);
  kit.place("cart_body", node, {}, "cart_body", [&](MeshDraft& draft) {
    draft.add(kit.material("light_grey_paint"), standing_box(1.10, 0.66, 0.20, 0.03).move(0, 0, 0.07));
    draft.add(kit.material("black_paint"), standing_box(1.14, 0.70, 0.06, 0.02).move(0, 0, 0.09));
    draft.add(kit.material("yellow_paint"), standing_box(1.02, 0.60, 0.02, 0.004).move(0, 0, 0.27));
    for (const double x : {-0.38, 0.38}) {
      for (const double y : {-0.27, 0.27}) {
        draft.add(kit.material("rubber"), cylinder({x, y - 0.03, 0.08}, {x, y + 0.03, 0.08}, 0.08, 16));
      }
    }
    draft.add(kit.material("dark_steel"), standing_box(0.06, 0.30, 0.08, 0.008).move(0.54, 0, 0.16));
  });
  add_carton_stack(kit, node, {-0.05, 0, 0.29}, 2, 1, 2, 0.40, 0.40, 0.30, "cart");
  return node;
}

int add_block(Kit& kit, int parent, const Placement& at) {
  return kit.place("block", parent, at, "block", [&](MeshDraft& draft) {
    draft.add(kit.material("aluminium"), standing_box(0.09, 0.06, 0.035, 0.004));
    draft.add(kit.material("dark_steel"), cylinder({0, 0, 0.035}, {0, 0, 0.05}, 0.02, 14));
  });
}

int add_vehicle(Kit& kit, int parent, const Placement& at) {
  const int node = kit.group("vehicle", parent, at);
  kit.place("vehicle_base", node, {}, "vehicle_base", [&](MeshDraft& draft) {
    draft.add(kit.material("black_paint"), standing_box(0.90, 0.60, 0.18, 0.02).move(0, 0, 0.06));
    // The upper half leaves the laser's field free: 270 deg from the front left corner, 0.3 m high.
    draft.add(kit.material("black_paint"), standing_box(0.57, 0.45, 0.11, 0.01).move(-0.165, -0.075, 0.24));
    for (const double x : {-0.30, 0.30}) {
      for (const double y : {-0.26, 0.26}) {
        draft.add(kit.material("rubber"), cylinder({x, y - 0.025, 0.07}, {x, y + 0.025, 0.07}, 0.07, 16));
      }
    }
  });
  kit.place("vehicle_frame", node, {}, "vehicle_frame", [&](MeshDraft& draft) {
    const auto post = [&](double x, double y, double from, double to) {
      draft.add(kit.material("aluminium"), standing_box(0.04, 0.04, to - from, 0.003).move(x, y, from));
    };
    for (const double y : {-0.27, 0.27}) {
      post(-0.42, y, 0.24, 0.95);
      post(-0.06, y, 0.24, 1.42);
    }
    draft.add(kit.material("aluminium"), standing_box(0.04, 0.58, 0.04, 0.003).move(-0.06, 0, 1.38));
    draft.add(kit.material("aluminium"), standing_box(0.40, 0.58, 0.05, 0.005).move(-0.24, 0, 0.92));
    draft.add(kit.material("rubber"), standing_box(0.38, 0.40, 0.03, 0.004).move(-0.24, 0, 0.97));
    draft.add(kit.material("dark_steel"), standing_box(0.025, 0.10, 0.04, 0.004).move(-0.026, 0, 1.38));
  });
  return node;
}

int add_board(Kit& kit, int parent, const Placement& at) {
  return kit.place("board", parent, at, "board", [&](MeshDraft& draft) {
    constexpr double kWidth = 0.80, kHeight = 0.59, kThick = 0.012;
    draft.add(kit.material("checkerboard"), picture({0, -kWidth / 2, -kHeight / 2}, {0, kWidth, 0}, {0, 0, kHeight}));
    draft.add(kit.material("aluminium"), box(kThick - 0.001, kWidth, kHeight).move(-0.001 - kThick / 2, 0, 0));
  });
}

int add_board_stand(Kit& kit, int parent, const Placement& at) {
  return kit.place("stand", parent, at, "stand", [&](MeshDraft& draft) {
    // The pole is far enough behind that the board can lean either way.
    constexpr double kHead = 0.42, kBehind = -0.22;
    const int steel = kit.material("dark_steel");
    draft.add(steel, cylinder({kBehind, 0, -kHead + 0.10}, {kBehind, 0, 0.015}, 0.015, 16));
    draft.add(steel, cylinder({kBehind, 0, 0}, {-0.02, 0, 0}, 0.012, 12));
    const double turns[] = {0, 110, 250};
    for (const double degrees : turns) {
      draft.add(steel, cylinder({0, 0, 0.11}, {-0.30, 0, 0.012}, 0.010, 12).rotate(Vector3d::UnitZ(), degrees).move(kBehind, 0, -kHead));
    }
  });
}

std::vector<std::string> mover_names() { return {"carton", "tote", "person", "cart", "block", "vehicle", "board", "stand"}; }

std::string build_mover(const std::string& name) {
  Kit kit;
  if (name == "carton") {
    add_carton(kit, -1, {}, 0.40, 0.30, 0.22);
  } else if (name == "tote") {
    add_tote(kit, -1, {});
  } else if (name == "person") {
    add_person(kit, -1, {});
  } else if (name == "cart") {
    add_cart(kit, -1, {});
  } else if (name == "block") {
    add_block(kit, -1, {});
  } else if (name == "vehicle") {
    add_vehicle(kit, -1, {});
  } else if (name == "board") {
    add_board(kit, -1, {});
  } else if (name == "stand") {
    add_board_stand(kit, -1, {});
  } else {
    throw Error("model '" + name + "' is not known; expected carton, tote, person, cart, block, vehicle, board or stand");
  }
  return kit.model.to_glb(name);
}

}  // namespace waretwin::builder
