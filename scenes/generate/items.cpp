#include "scenes/generate/items.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/builder/parts/furniture.h"
#include "scenes/builder/parts/storage.h"

namespace waretwin::generate {

namespace {

using builder::Kit;
using builder::Placement;

const std::vector<std::string> kBins = {"bin_green", "bin_green", "bin_blue", "bin_red"};
const std::vector<std::string> kBoards = {"birch", "beech", "chipboard"};
const std::vector<std::string> kScreens = {"screen_status", "screen_code", "screen_plot"};

Item bin(double length, double width, double height, const std::string& finish, bool filled) {
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_bin(kit, parent, at, length, width, height, finish, filled); });
}

Item cartons(Dice& dice) {
  const double dx = to_mm(dice.between(0.25, 0.55)), dy = to_mm(dice.between(0.2, 0.4)), dz = to_mm(dice.between(0.18, 0.4));
  const int layers = dice.whole(1, 3);
  const std::string key = "floor" + std::to_string(dice.whole(0, 999));
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_carton_stack(kit, parent, at, 1, 1, layers, dx, dy, dz, key); });
}

template <class Add>
Item simple(Add add) {
  return make_item([add](Kit& kit, int parent, const Placement& at) { add(kit, parent, at); });
}

// A small thing for a top, and how far its foot reaches from its middle; it may overhang beyond.
struct TopItem {
  Item item;
  double foot_x, foot_y;
  bool faces_front = false;
};

TopItem whole_foot(const Item& item, bool faces_front = false) {
  return {item, std::max(-item.extent.min().x(), item.extent.max().x()), std::max(-item.extent.min().y(), item.extent.max().y()),
          faces_front};
}

TopItem draw_top_item(Dice& dice) {
  const double kind = dice.unit();
  if (kind < 0.19) return {robot_arm(dice), 0.10, 0.10};
  if (kind < 0.39) {
    return whole_foot(bin(to_mm(dice.between(0.14, 0.34)), to_mm(dice.between(0.1, 0.24)), to_mm(dice.between(0.08, 0.16)),
                          dice.pick(kBins), dice.chance(0.5)));
  }
  if (kind < 0.48) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_tools(k, p, at); }));
  if (kind < 0.58) return whole_foot(monitor(dice), true);
  if (kind < 0.64) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_control_box(k, p, at); }), true);
  if (kind < 0.70) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_signal_tower(k, p, at); }));
  if (kind < 0.75) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_toolbox(k, p, at); }));
  if (kind < 0.80) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_laptop(k, p, at); }), true);
  if (kind < 0.84) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_book_stack(k, p, at); }));
  if (kind < 0.88) return whole_foot(simple([](Kit& k, int p, const Placement& at) { builder::add_cup(k, p, at); }));
  const double dx = to_mm(dice.between(0.15, 0.34)), dy = to_mm(dice.between(0.12, 0.28)), dz = to_mm(dice.between(0.1, 0.26));
  return whole_foot(simple([=](Kit& k, int p, const Placement& at) { builder::add_carton(k, p, at, dx, dy, dz); }));
}

}  // namespace

Item chair(Dice& dice) {
  const std::string fabric = dice.chance(0.6) ? "fabric_black" : "fabric_blue";
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_office_chair(kit, parent, at, fabric); });
}

Item bin_stack(Dice& dice) {
  const double length = to_mm(dice.between(0.35, 0.6)), width = to_mm(dice.between(0.28, 0.4)), height = to_mm(dice.between(0.17, 0.3));
  const int count = dice.whole(1, 3);
  const std::string finish = dice.pick(kBins);
  const double turn = dice.between(-3, 3);
  return make_item([=](Kit& kit, int parent, const Placement& at) {
    const int stack = kit.group("bins", parent, at);
    for (int i = 0; i < count; ++i) {
      add_bin(kit, stack, {0, 0, i * height, i % 2 == 0 ? 0 : turn}, length, width, height, finish, i + 1 == count);
    }
  });
}

Item table(double width, double depth, double height, const std::string& top, bool shelf) {
  return make_item([=](Kit& kit, int parent, const Placement& at) {
    add_table(kit, parent, at, {.width = width, .depth = depth, .height = height, .top = top, .shelf = shelf});
  });
}

Item cabinet(double width, double depth, double height, bool drawers) {
  return make_item([=](Kit& kit, int parent, const Placement& at) {
    add_cabinet(kit, parent, at, {.width = width, .depth = depth, .height = height, .drawers = drawers});
  });
}

Item robot_arm(Dice& dice) {
  const builder::RobotArm arm{.base_deg = std::round(dice.between(-180, 180)),
                              .shoulder_deg = std::round(dice.between(-5, 30)),
                              .elbow_deg = std::round(dice.between(60, 105)),
                              .wrist_deg = std::round(dice.between(40, 80)),
                              .gripper = dice.chance(0.7)};
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_robot_arm(kit, parent, at, arm); });
}

Item monitor(Dice& dice) {
  const std::string screen = dice.pick(kScreens);
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_monitor(kit, parent, at, screen); });
}

Item loaded_pallet(Dice& dice) {
  const int kind = dice.whole(0, 3);
  const std::string key = "pallet" + std::to_string(dice.whole(0, 999));
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_loaded_pallet(kit, parent, at, kind, key); });
}

Item draw_leaning_panel(Dice& dice) {
  const double width = to_mm(dice.between(0.4, 1.0)), height = to_mm(dice.between(0.45, 1.25));
  const double thickness = to_mm(dice.between(0.012, 0.022)), lean = to_mm(dice.between(7.5, 11));
  const std::string finish = dice.pick(kBoards);
  return make_item(
      [=](Kit& kit, int parent, const Placement& at) { add_leaning_panel(kit, parent, at, width, height, thickness, lean, finish); });
}

Item draw_floor_item(Dice& dice) {
  const double kind = dice.unit();
  if (kind < 0.22) return chair(dice);
  if (kind < 0.32) return simple([](Kit& k, int p, const Placement& at) { builder::add_stool(k, p, at); });
  if (kind < 0.50) return bin_stack(dice);
  if (kind < 0.58) return simple([](Kit& k, int p, const Placement& at) { builder::add_waste_bin(k, p, at); });
  if (kind < 0.72) return cartons(dice);
  if (kind < 0.80) return simple([](Kit& k, int p, const Placement& at) { builder::add_trolley(k, p, at); });
  if (kind < 0.86) {
    const std::string screen = dice.pick(kScreens);
    const double height = to_mm(dice.between(1.2, 1.6));
    return make_item([=](Kit& kit, int parent, const Placement& at) { add_monitor_stand(kit, parent, at, screen, height); });
  }
  if (kind < 0.96) return loaded_pallet(dice);
  return simple([](Kit& k, int p, const Placement& at) { builder::add_plant(k, p, at); });
}

WallItem draw_wall_item(Dice& dice, double room_height) {
  const double kind = dice.unit();
  if (kind < 0.25) {
    const double width = to_mm(dice.between(0.9, 1.8)), height = to_mm(dice.between(1.0, std::min(2.1, room_height - 0.4)));
    return {make_item([=](Kit& kit, int parent, const Placement& at) { add_shelf(kit, parent, at, width, height); })};
  }
  if (kind < 0.60) {
    const double width = to_mm(dice.between(0.9, 1.6)), depth = to_mm(dice.between(0.55, 0.8)), height = to_mm(dice.between(0.70, 0.78));
    return {table(width, depth, height, dice.chance(0.5) ? "table_top" : "beech", dice.chance(0.3)), width, depth, height, true};
  }
  if (kind < 0.78) {
    const double width = to_mm(dice.between(0.6, 1.1)), depth = to_mm(dice.between(0.5, 0.7)), height = to_mm(dice.between(0.75, 1.1));
    return {cabinet(width, depth, height, dice.chance(0.5)), width, depth, height};
  }
  return {draw_leaning_panel(dice)};
}

void furnish(HallPlan& plan, const Top& top, int count, double margin, Dice& dice) {
  constexpr int kTries = 12;
  for (int i = 0; i < count; ++i) {
    const TopItem drawn = draw_top_item(dice);
    const double free_x = top.width / 2 - drawn.foot_x - 0.01, free_y = top.depth / 2 - drawn.foot_y - 0.01;
    bool done = false;
    for (int attempt = 0; attempt < kTries && !done; ++attempt) {
      const double x = dice.between(-1, 1), y = dice.between(-1, 1), turn = dice.between(-1, 1);
      if (free_x < 0 || free_y < 0) break;
      const double yaw = drawn.faces_front ? 20 * turn : std::abs(turn) < 0.8 ? 12 * turn : 180 * turn;
      // Turned things reach farther; those near the edge stay nearly straight.
      const double grow =
          drawn.foot_x == drawn.foot_y ? 0.0 : std::abs(std::sin(yaw * std::numbers::pi / 180)) * std::hypot(drawn.foot_x, drawn.foot_y);
      if (std::abs(x) * free_x + grow * 0.6 > free_x || std::abs(y) * free_y + grow * 0.6 > free_y) continue;
      done = plan.try_add(drawn.item, placed(top.at, {x * free_x, y * free_y, 0, yaw}), margin);
    }
  }
}

}  // namespace waretwin::generate
