#include "scenes/builder/parts/furniture.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"
#include "core/random.h"

namespace waretwin::builder {
namespace {

Shape leg(double x, double y, double z0, double z1, double size) { return standing_box(size, size, z1 - z0).move(x, y, z0); }

}  // namespace

int add_cabinet(Kit& kit, int parent, const Placement& at, const Cabinet& c) {
  const std::string name = "cabinet_" + in_mm({c.width, c.depth, c.height}) + (c.drawers ? "_drawers" : "");
  return kit.place("cabinet", parent, at, name, [&](MeshDraft& draft) {
    const double foot = 0.07, top = 0.028, body = c.height - foot - top;
    const int grey = kit.material("cabinet_grey");
    draft.add(grey, standing_box(c.width - 0.02, c.depth - 0.02, body, 0.004).move(0, 0, foot));
    draft.add(kit.material("cabinet_top"), standing_box(c.width, c.depth, top, 0.004).move(0, 0, c.height - top));
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        draft.add(kit.material("aluminium"), leg(x * (c.width / 2 - 0.018), y * (c.depth / 2 - 0.018), foot, c.height - top, 0.036));
        draft.add(kit.material("rubber"), cylinder({x * (c.width / 2 - 0.06), y * (c.depth / 2 - 0.06), 0},
                                                   {x * (c.width / 2 - 0.06), y * (c.depth / 2 - 0.06), foot}, 0.025, 10));
      }
    }
    const double front = -c.depth / 2 + 0.004;
    const int panels = c.drawers ? 3 : 2;
    for (int i = 0; i < panels; ++i) {
      const double w = c.drawers ? c.width - 0.10 : (c.width - 0.11) / 2, h = c.drawers ? (body - 0.06) / 3 - 0.01 : body - 0.05;
      const double x = c.drawers ? 0 : (i - 0.5) * (w + 0.008), z = foot + 0.025 + (c.drawers ? i * (h + 0.01) : 0);
      draft.add(grey, standing_box(w, 0.016, h, 0.004).move(x, front, z));
      const double hx = c.drawers ? 0 : (i == 0 ? w / 2 - 0.03 : -w / 2 + 0.03);
      if (c.drawers) {
        draft.add(kit.material("aluminium"), bevelled_box(0.16, 0.018, 0.014, 0.003).move(x, front - 0.014, z + h - 0.05));
      } else {
        draft.add(kit.material("aluminium"), bevelled_box(0.014, 0.018, 0.14, 0.003).move(x + hx, front - 0.014, z + h - 0.14));
      }
    }
    draft.add(kit.material("label_warning"),
              picture({-c.width / 4 - 0.04, front - 0.0085, foot + body - 0.17}, {0.08, 0, 0}, {0, 0, 0.08}));
  });
}

int add_table(Kit& kit, int parent, const Placement& at, const Table& t) {
  return kit.place("table", parent, at, "table_" + in_mm({t.width, t.depth, t.height}) + t.top + (t.shelf ? "_shelf" : ""),
                   [&](MeshDraft& draft) {
                     draft.add(kit.material(t.top), standing_box(t.width, t.depth, 0.03, 0.003).move(0, 0, t.height - 0.03));
                     const int frame = kit.material("aluminium");
                     for (const double x : {-1.0, 1.0}) {
                       for (const double y : {-1.0, 1.0})
                         draft.add(frame, leg(x * (t.width / 2 - 0.05), y * (t.depth / 2 - 0.05), 0, t.height - 0.03, 0.045));
                       draft.add(frame, standing_box(0.03, t.depth - 0.14, 0.05).move(x * (t.width / 2 - 0.05), 0, t.height - 0.08));
                     }
                     for (const double y : {-1.0, 1.0})
                       draft.add(frame, standing_box(t.width - 0.14, 0.03, 0.05).move(0, y * (t.depth / 2 - 0.05), t.height - 0.08));
                     if (t.shelf) draft.add(kit.material("chipboard"), standing_box(t.width - 0.1, t.depth - 0.1, 0.02).move(0, 0, 0.18));
                   });
}

int add_robot_arm(Kit& kit, int parent, const Placement& at, const RobotArm& arm) {
  const std::string name = "robot_arm_" + in_mm({arm.base_deg, arm.shoulder_deg, arm.elbow_deg, arm.wrist_deg}) + (arm.gripper ? "g" : "");
  return kit.place("robot_arm", parent, at, name, [&](MeshDraft& draft) {
    const int grey = kit.material("robot_grey"), blue = kit.material("joint_blue"), black = kit.material("black_plastic");
    // A joint: a short fat cylinder across the arm's plane (y) with a blue cap on its outer end.
    const auto in_plane = [&](double angle_deg) {
      const double a = to_radians(angle_deg);
      return Vector3d(std::sin(a), 0, std::cos(a));
    };
    const auto turn = [&](Shape s) { return s.rotate(Vector3d::UnitZ(), arm.base_deg); };
    const auto joint = [&](const Vector3d& centre, double side, double radius, double length) {
      const Vector3d y(0, side, 0);
      draft.add(grey, turn(cylinder(centre - y * length / 2, centre + y * length / 2, radius, 18)));
      Shape cap = turned({{0, 0}, {radius * 1.01, 0}, {radius * 1.01, 0.012}, {radius * 0.75, 0.024}, {0, 0.026}}, 18);
      cap.rotate(Vector3d::UnitX(), side > 0 ? -90 : 90);
      const Vector3d outer = centre + y * length / 2;
      draft.add(blue, turn(cap.move(outer.x(), outer.y(), outer.z())));
    };
    const auto link = [&](const Vector3d& a, const Vector3d& b, double radius) { draft.add(grey, turn(cylinder(a, b, radius, 16))); };
    draft.add(black, turned({{0, 0}, {0.085, 0}, {0.085, 0.014}, {0, 0.014}}, 20));
    draft.add(grey, turned({{0.064, 0.014}, {0.062, 0.07}, {0.058, 0.10}, {0, 0.10}}, 20));
    const Vector3d shoulder(0, 0, 0.135);
    joint(shoulder, -1, 0.056, 0.12);
    const double upper = 0.28, fore = 0.24;
    const Vector3d offset(0, -0.075, 0);
    const Vector3d u = in_plane(arm.shoulder_deg), f = in_plane(arm.shoulder_deg + arm.elbow_deg);
    const Vector3d elbow = shoulder + offset + u * upper;
    link(shoulder + offset, elbow, 0.038);
    joint(shoulder + offset, -1, 0.052, 0.05);
    joint(elbow, -1, 0.045, 0.09);
    const Vector3d start = elbow - offset * 0.55;
    joint(start, 1, 0.043, 0.05);
    const Vector3d wrist = start + f * fore;
    link(start, wrist, 0.030);
    joint(wrist, 1, 0.034, 0.075);
    const Vector3d w = in_plane(arm.shoulder_deg + arm.elbow_deg + arm.wrist_deg);
    const Vector3d wrist2 = wrist + Vector3d(0, -0.05, 0), wrist3 = wrist2 + w * 0.075;
    joint(wrist2, -1, 0.033, 0.06);
    link(wrist2, wrist3, 0.030);
    draft.add(blue, turn(cylinder(wrist3, wrist3 + w * 0.012, 0.031, 16)));
    if (arm.gripper) {
      const Vector3d palm = wrist3 + w * 0.012, tip = palm + w * 0.10;
      draft.add(black, turn(cylinder(palm, palm + w * 0.05, 0.026, 12)));
      for (const double side : {-0.022, 0.022}) {
        draft.add(black, turn(cylinder(palm + w * 0.05 + Vector3d(0, side, 0), tip + Vector3d(0, side, 0), 0.008, 6)));
      }
    }
    // The cable along the upper arm.
    draft.add(kit.material("cable_black"),
              turn(tube(smooth_path({shoulder + Vector3d(-0.06, 0.03, -0.09), shoulder + Vector3d(-0.09, -0.02, 0.06),
                                     shoulder + offset + u * 0.18 + Vector3d(-0.06, 0, 0), elbow + Vector3d(-0.05, 0, 0.02),
                                     start + f * 0.14 + Vector3d(0, 0.02, 0.05)},
                                    4),
                        0.007, 6)));
  });
}

int add_bin(Kit& kit, int parent, const Placement& at, double length, double width, double height, const std::string& finish, bool filled) {
  return kit.place("bin", parent, at, "bin_" + finish + in_mm({length, width, height}) + (filled ? "_filled" : ""), [&](MeshDraft& draft) {
    const double t = 0.004;
    const int m = kit.material(finish);
    draft.add(m, standing_box(length, width, t));
    draft.add(m, standing_box(length, t, height).move(0, width / 2 - t / 2, 0));
    draft.add(m, standing_box(length, t, height * 0.55).move(0, -width / 2 + t / 2, 0));
    for (const double side : {-1.0, 1.0}) {
      const Profile outline = {{-width / 2, 0}, {width / 2, 0}, {width / 2, height}, {-width / 4, height}, {-width / 2, height * 0.55}};
      draft.add(m, extruded(outline, t).move(side * (length - t) / 2, 0, 0));
      draft.add(m, bevelled_box(0.01, width * 0.6, 0.012, 0.003).move(side * (length / 2 + 0.003), width * 0.12, height - 0.008));
    }
    draft.add(m, bevelled_box(length + 0.008, 0.012, 0.014, 0.003).move(0, width / 2, height - 0.007));
    draft.add(kit.material("paper"),
              rectangle({-length * 0.22, -width / 2 - 0.0006, height * 0.14}, {length * 0.44, 0, 0}, {0, 0, height * 0.26}));
    if (filled) {
      const RandomStream random(0, "bin", "content");
      for (std::uint64_t i = 0; i < 7; ++i) {
        const double x = (random.uniform(i, 0) - 0.5) * length * 0.6, y = (random.uniform(i, 1) - 0.5) * width * 0.6;
        const double r = 0.012 + 0.012 * random.uniform(i, 2), tilt = 6.28 * random.uniform(i, 3),
                     z = t + r + 0.012 * static_cast<double>(i % 3);
        draft.add(kit.material(i % 2 == 0 ? "steel" : "dark_steel"),
                  cylinder({x, y, z}, {x + 0.05 * std::cos(tilt), y + 0.05 * std::sin(tilt), z}, r, 8));
      }
    }
  });
}

int add_monitor(Kit& kit, int parent, const Placement& at, const std::string& screen) {
  return kit.place("monitor", parent, at, "monitor_" + screen, [&](MeshDraft& draft) {
    const int black = kit.material("black_plastic");
    draft.add(black, standing_box(0.24, 0.18, 0.012, 0.004).move(0, 0.02, 0));
    draft.add(black, standing_box(0.05, 0.03, 0.30, 0.004).move(0, 0.06, 0.01));
    draft.add(black, standing_box(0.54, 0.03, 0.325, 0.006).move(0, 0.025, 0.14));
    draft.add(kit.material(screen), picture({-0.26, 0.0095, 0.153}, {0.52, 0, 0}, {0, 0, 0.2925}));
  });
}

int add_monitor_stand(Kit& kit, int parent, const Placement& at, const std::string& screen, double height) {
  const int node = kit.place("monitor_stand", parent, at, "monitor_stand_" + in_mm({height}), [&](MeshDraft& draft) {
    draft.add(kit.material("black_paint"), standing_box(0.45, 0.06, 0.04, 0.005).move(0, 0, 0.01));
    draft.add(kit.material("black_paint"), standing_box(0.06, 0.45, 0.04, 0.005).move(0, 0, 0.01));
    draft.add(kit.material("aluminium"), standing_box(0.045, 0.045, height).move(0, 0, 0.04));
    draft.add(kit.material("grey_plastic"), standing_box(0.24, 0.12, 0.3, 0.008).move(0, 0.06, height * 0.42));
  });
  kit.place("monitor", node, {0, -0.04, height - 0.22}, "monitor_panel_" + screen, [&](MeshDraft& draft) {
    draft.add(kit.material("black_plastic"), standing_box(0.54, 0.03, 0.325, 0.006));
    draft.add(kit.material(screen), picture({-0.26, -0.0155, 0.016}, {0.52, 0, 0}, {0, 0, 0.2925}));
  });
  return node;
}

int add_keyboard(Kit& kit, int parent, const Placement& at) {
  return kit.place("keyboard", parent, at, "keyboard", [&](MeshDraft& draft) {
    draft.add(kit.material("black_plastic"), standing_box(0.43, 0.145, 0.018, 0.004));
    draft.add(kit.material("keyboard"), picture({-0.21, -0.067, 0.0185}, {0.42, 0, 0}, {0, 0.134, 0}));
    draft.add(kit.material("black_plastic"), standing_box(0.06, 0.10, 0.03, 0.012).move(0.30, 0.0, 0));
  });
}

int add_office_chair(Kit& kit, int parent, const Placement& at, const std::string& fabric) {
  return kit.place("office_chair", parent, at, "office_chair_" + fabric, [&](MeshDraft& draft) {
    const int black = kit.material("black_plastic"), cloth = kit.material(fabric);
    for (int i = 0; i < 5; ++i) {
      const double a = 72 * i + 18;
      Shape spoke = bevelled_box(0.29, 0.045, 0.035, 0.008).move(0.155, 0, 0.085).rotate(Vector3d::UnitY(), 4).rotate(Vector3d::UnitZ(), a);
      draft.add(black, spoke);
      const Vector3d w = Eigen::AngleAxisd(to_radians(a), Vector3d::UnitZ()) * Vector3d(0.29, 0, 0.028);
      const Vector3d axle = Eigen::AngleAxisd(to_radians(a + 60), Vector3d::UnitZ()) * Vector3d(0, 0.022, 0);
      draft.add(kit.material("rubber"), cylinder(w - axle, w + axle, 0.028, 12));
      draft.add(black, cylinder(w, w + Vector3d(0, 0, 0.05), 0.008, 6));
    }
    draft.add(kit.material("chrome"), cylinder({0, 0, 0.08}, {0, 0, 0.42}, 0.025, 12));
    draft.add(black, cylinder({0, 0, 0.10}, {0, 0, 0.26}, 0.035, 12));
    draft.add(black, bevelled_box(0.24, 0.22, 0.04, 0.01).move(0, 0, 0.425));
    draft.add(cloth, bevelled_box(0.48, 0.47, 0.075, 0.03).move(0, 0, 0.48));
    draft.add(black, bevelled_box(0.07, 0.03, 0.30, 0.008).rotate(Vector3d::UnitX(), 8).move(0, 0.25, 0.58));
    draft.add(cloth, bevelled_box(0.44, 0.065, 0.50, 0.028).rotate(Vector3d::UnitX(), -8).move(0, 0.27, 0.83));
    for (const double side : {-1.0, 1.0}) {
      draft.add(black, bevelled_box(0.03, 0.05, 0.22, 0.008).move(side * 0.27, 0.04, 0.57));
      draft.add(black, bevelled_box(0.06, 0.26, 0.03, 0.01).move(side * 0.27, 0, 0.69));
      draft.add(black, bevelled_box(0.14, 0.05, 0.02, 0.004).move(side * 0.21, 0.04, 0.455));
    }
  });
}

int add_stool(Kit& kit, int parent, const Placement& at) {
  return kit.place("stool", parent, at, "stool", [&](MeshDraft& draft) {
    draft.add(kit.material("fabric_black"), turned({{0, 0.55}, {0.16, 0.55}, {0.17, 0.57}, {0.165, 0.61}, {0, 0.62}}, 20));
    draft.add(kit.material("chrome"), cylinder({0, 0, 0.1}, {0, 0, 0.55}, 0.022, 10));
    for (int i = 0; i < 5; ++i)
      draft.add(kit.material("chrome"), bevelled_box(0.24, 0.03, 0.03, 0.006).move(0.13, 0, 0.07).rotate(Vector3d::UnitZ(), 72 * i));
    for (int i = 0; i < 5; ++i) {
      const Vector3d w = Eigen::AngleAxisd(to_radians(72 * i), Vector3d::UnitZ()) * Vector3d(0.24, 0, 0.03);
      draft.add(kit.material("rubber"), cylinder(w - Vector3d(0, 0, 0.03), w + Vector3d(0, 0, 0.025), 0.022, 10));
    }
  });
}

int add_leaning_panel(Kit& kit, int parent, const Placement& at, double width, double height, double thickness, double lean_deg,
                      const std::string& finish) {
  return kit.place("panel", parent, at, "panel_" + finish + in_mm({width, height, thickness, lean_deg}), [&](MeshDraft& draft) {
    // Turned about the lower edge that it rests on.
    draft.add(kit.material(finish),
              standing_box(width, thickness, height, 0.001).move(0, -thickness / 2, 0).rotate(Vector3d::UnitX(), -lean_deg));
  });
}

int add_cable(Kit& kit, int parent, const std::string& name, const std::vector<Vector3d>& points, double radius,
              const std::string& finish) {
  return kit.place(name, parent, {}, name, [&](MeshDraft& draft) {
    std::vector<Vector3d> path = smooth_path(points, 6);
    for (Vector3d& p : path) p.z() = std::max(p.z(), radius);  // the curve may swing below the floor
    draft.add(kit.material(finish), tube(path, radius, 6));
  });
}

int add_tools(Kit& kit, int parent, const Placement& at) {
  return kit.place("tools", parent, at, "tools", [&](MeshDraft& draft) {
    const auto driver = [&](double x, double y, double yaw, const char* handle) {
      Shape grip = cylinder({0, 0, 0.014}, {0.10, 0, 0.014}, 0.013, 8), blade = cylinder({0.10, 0, 0.014}, {0.21, 0, 0.010}, 0.0035, 6);
      draft.add(kit.material(handle), grip.rotate(Vector3d::UnitZ(), yaw).move(x, y, 0));
      draft.add(kit.material("chrome"), blade.rotate(Vector3d::UnitZ(), yaw).move(x, y, 0));
    };
    driver(-0.12, 0.06, 8, "bin_red");
    driver(-0.10, 0.02, -14, "yellow_paint");
    Shape wrench = bevelled_box(0.19, 0.018, 0.007, 0.002);
    wrench.append(turned({{0, -0.004}, {0.02, -0.004}, {0.02, 0.004}, {0, 0.004}}, 10).move(0.095, 0, 0));
    wrench.append(turned({{0, -0.004}, {0.015, -0.004}, {0.015, 0.004}, {0, 0.004}}, 10).move(-0.095, 0, 0));
    draft.add(kit.material("chrome"), wrench.rotate(Vector3d::UnitZ(), 25).move(0.02, -0.06, 0.004));
    draft.add(kit.material("bin_blue"), standing_box(0.07, 0.05, 0.035, 0.004).move(0.13, 0.04, 0));
    draft.add(kit.material("cardboard"), standing_box(0.05, 0.04, 0.03).rotate(Vector3d::UnitZ(), 30).move(0.12, -0.05, 0));
  });
}

int add_toolbox(Kit& kit, int parent, const Placement& at) {
  return kit.place("toolbox", parent, at, "toolbox", [&](MeshDraft& draft) {
    draft.add(kit.material("red_paint"), standing_box(0.44, 0.22, 0.17, 0.008));
    draft.add(kit.material("black_plastic"), standing_box(0.45, 0.23, 0.05, 0.01).move(0, 0, 0.165));
    draft.add(kit.material("black_plastic"),
              tube(smooth_path({{-0.1, 0, 0.21}, {-0.09, 0, 0.25}, {0.09, 0, 0.25}, {0.1, 0, 0.21}}, 4), 0.011, 8));
    for (const double x : {-0.13, 0.13}) draft.add(kit.material("chrome"), bevelled_box(0.04, 0.012, 0.05, 0.003).move(x, -0.115, 0.15));
  });
}

int add_cup(Kit& kit, int parent, const Placement& at) {
  return kit.place("cup", parent, at, "cup", [&](MeshDraft& draft) {
    draft.add(kit.material("white_plastic"), turned({{0, 0}, {0.034, 0}, {0.040, 0.09}, {0.036, 0.09}, {0.031, 0.006}, {0, 0.006}}, 16));
    draft.add(kit.material("white_plastic"),
              tube(smooth_path({{0.038, 0, 0.075}, {0.065, 0, 0.06}, {0.06, 0, 0.03}, {0.036, 0, 0.02}}, 4), 0.005, 6));
  });
}

int add_book_stack(Kit& kit, int parent, const Placement& at) {
  return kit.place("books", parent, at, "books", [&](MeshDraft& draft) {
    const char* colours[] = {"bin_blue", "white_plastic", "bin_red", "grey_plastic"};
    double z = 0;
    for (int i = 0; i < 4; ++i) {
      const double h = 0.022 + 0.006 * (i % 2), w = 0.30 - 0.02 * i;
      draft.add(kit.material(colours[i]), standing_box(w, 0.215, h, 0.002).rotate(Vector3d::UnitZ(), 7.0 * (i % 3) - 6).move(0, 0, z));
      draft.add(kit.material("paper"),
                standing_box(w - 0.01, 0.219, h - 0.008).rotate(Vector3d::UnitZ(), 7.0 * (i % 3) - 6).move(0, 0, z + 0.004));
      z += h;
    }
  });
}

int add_laptop(Kit& kit, int parent, const Placement& at) {
  return kit.place("laptop", parent, at, "laptop", [&](MeshDraft& draft) {
    draft.add(kit.material("grey_plastic"), standing_box(0.34, 0.24, 0.016, 0.004));
    draft.add(kit.material("keyboard"), picture({-0.15, -0.03, 0.0165}, {0.3, 0, 0}, {0, 0.12, 0}));
    Shape lid = standing_box(0.34, 0.008, 0.22, 0.002), glass = picture({-0.16, -0.0045, 0.015}, {0.32, 0, 0}, {0, 0, 0.18});
    draft.add(kit.material("grey_plastic"), lid.rotate(Vector3d::UnitX(), -20).move(0, 0.12, 0.016));
    draft.add(kit.material("screen_code"), glass.rotate(Vector3d::UnitX(), -20).move(0, 0.12, 0.016));
  });
}

int add_waste_bin(Kit& kit, int parent, const Placement& at) {
  return kit.place("waste_bin", parent, at, "waste_bin", [&](MeshDraft& draft) {
    draft.add(kit.material("black_plastic"), turned({{0, 0}, {0.12, 0}, {0.15, 0.40}, {0.14, 0.40}, {0.115, 0.01}, {0, 0.01}}, 20));
    draft.add(kit.material("stretch_film"), turned({{0.152, 0.33}, {0.154, 0.405}, {0.138, 0.405}, {0.13, 0.2}}, 20));
  });
}

int add_plant(Kit& kit, int parent, const Placement& at) {
  return kit.place("plant", parent, at, "plant", [&](MeshDraft& draft) {
    draft.add(kit.material("white_plastic"), turned({{0, 0}, {0.14, 0}, {0.18, 0.36}, {0.165, 0.36}, {0.16, 0.32}, {0, 0.32}}, 20));
    draft.add(kit.material("soil"), turned({{0.162, 0.325}, {0, 0.33}}, 20));
    const RandomStream random(0, "plant", "leaves");
    for (std::uint64_t i = 0; i < 26; ++i) {
      const double a = 360 * random.uniform(i, 0), lean = 15 + 45 * random.uniform(i, 1), length = 0.35 + 0.45 * random.uniform(i, 2);
      Profile blade;
      for (int k = 0; k <= 6; ++k) blade.emplace_back(0.03 * std::sin(3.1416 * k / 6.0) + 0.003, length * k / 6.0);
      for (int k = 6; k >= 0; --k) blade.emplace_back(-0.03 * std::sin(3.1416 * k / 6.0) - 0.003, length * k / 6.0);
      Shape leaf = extruded(blade, 0.002);
      draft.add(kit.material("leaf"), leaf.rotate(Vector3d::UnitY(), lean).rotate(Vector3d::UnitZ(), a).move(0, 0, 0.32));
    }
  });
}

int add_shelf(Kit& kit, int parent, const Placement& at, double width, double height) {
  const int node = kit.place("shelf", parent, at, "shelf_" + in_mm({width, height}), [&](MeshDraft& draft) {
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) draft.add(kit.material("galvanised"), leg(x * (width / 2 - 0.02), y * 0.18, 0, height, 0.035));
    }
    for (int i = 0; i < 4; ++i)
      draft.add(kit.material("galvanised"), standing_box(width, 0.4, 0.03).move(0, 0, 0.12 + i * (height - 0.2) / 3));
  });
  const RandomStream random(0, "shelf", "content");
  const char* finishes[] = {"bin_green", "bin_blue", "bin_green", "bin_red"};
  for (int level = 0; level < 4; ++level) {
    const double z = 0.15 + level * (height - 0.2) / 3;
    int i = 0;
    for (double x = -width / 2 + 0.18; x < width / 2 - 0.15; x += 0.27, ++i) {
      const auto key = static_cast<std::uint64_t>(level * 10 + i);
      if (random.uniform(key, 0) < 0.18) continue;
      if (random.uniform(key, 1) < 0.55) {
        add_bin(kit, node, {x, -0.02, z}, 0.22, 0.34, 0.16, finishes[(level + i) % 4], level < 2);
      } else {
        kit.place("carton", node, {x, 0, z, 8 * random.uniform(key, 2) - 4}, "carton_shelf", [&](MeshDraft& draft) {
          draft.add(kit.material("cardboard"), standing_box(0.22, 0.3, 0.2, 0.002));
          draft.add(kit.material("packing_tape"), standing_box(0.05, 0.302, 0.201));
          draft.add(kit.material("label_parcel"), picture({-0.09, -0.1515, 0.05}, {0.06, 0, 0}, {0, 0, 0.09}));
        });
      }
    }
  }
  return node;
}

int add_control_box(Kit& kit, int parent, const Placement& at) {
  return kit.place("control_box", parent, at, "control_box", [&](MeshDraft& draft) {
    draft.add(kit.material("yellow_paint"), standing_box(0.10, 0.08, 0.10, 0.006));
    draft.add(kit.material("bin_red"), turned({{0, 0.10}, {0.012, 0.10}, {0.012, 0.115}, {0.022, 0.115}, {0.022, 0.125}, {0, 0.13}}, 14));
  });
}

int add_trolley(Kit& kit, int parent, const Placement& at) {
  return kit.place("trolley", parent, at, "trolley", [&](MeshDraft& draft) {
    for (const double z : {0.18, 0.62}) draft.add(kit.material("beech"), standing_box(0.85, 0.5, 0.025, 0.003).move(0, 0, z));
    for (const double x : {-0.40, 0.40}) {
      for (const double y : {-0.23, 0.23}) {
        draft.add(kit.material("blue_paint"), cylinder({x, y, 0.15}, {x, y, x < 0 ? 0.95 : 0.70}, 0.014, 10));
        draft.add(kit.material("rubber"), cylinder({x, y - 0.018, 0.062}, {x, y + 0.018, 0.062}, 0.062, 14));
        draft.add(kit.material("steel"), standing_box(0.05, 0.06, 0.04).move(x, y, 0.12));
      }
    }
    draft.add(kit.material("blue_paint"), cylinder({-0.40, -0.23, 0.94}, {-0.40, 0.23, 0.94}, 0.014, 10));
    draft.add(kit.material("cardboard"), standing_box(0.36, 0.3, 0.24, 0.002).rotate(Vector3d::UnitZ(), 9).move(0.15, 0, 0.645));
    draft.add(kit.material("cardboard"), standing_box(0.3, 0.34, 0.2, 0.002).rotate(Vector3d::UnitZ(), -5).move(-0.15, 0, 0.205));
  });
}

int add_signal_tower(Kit& kit, int parent, const Placement& at) {
  return kit.place("signal_tower", parent, at, "signal_tower", [&](MeshDraft& draft) {
    draft.add(kit.material("grey_plastic"), turned({{0, 0}, {0.03, 0}, {0.03, 0.015}, {0.009, 0.02}, {0.009, 0.28}, {0, 0.28}}, 12));
    const char* colours[] = {"bin_green", "yellow_paint", "bin_red"};
    for (int i = 0; i < 3; ++i)
      draft.add(kit.material(colours[i]), cylinder({0, 0, 0.28 + 0.055 * i}, {0, 0, 0.33 + 0.055 * i}, 0.027, 14));
    draft.add(kit.material("black_plastic"), cylinder({0, 0, 0.445}, {0, 0, 0.46}, 0.027, 14));
  });
}

}  // namespace waretwin::builder
