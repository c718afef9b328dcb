#include "core/random.h"
#include "scenes/builder/halls.h"
#include "scenes/builder/parts/conveyors.h"
#include "scenes/builder/parts/furniture.h"
#include "scenes/builder/parts/room.h"
#include "scenes/builder/parts/storage.h"

namespace waretwin::builder {
namespace {

constexpr double kLength = 40.0, kWidth = 25.0, kHeight = 7.0;
// Conveyor segments stand 1 cm apart, as bolted ones nearly do.
constexpr double kGap = 0.01;

void add_room(Kit& kit, int hall) {
  const int room = kit.group("room", hall);
  add_floor(kit, room, kLength, kWidth);
  add_ceiling(kit, room, kLength, kWidth, kHeight);
  const double x = kLength / 2, y = kWidth / 2;
  add_wall(kit, room, "wall_south", {-x, -y, x, -y, kHeight, {{6, 0, 3.5, 4}, {14, 0, 3.5, 4}, {26, 0, 1, 2.1}}, "wall_grey"});
  add_wall(kit, room, "wall_east", {x, -y, x, y, kHeight, {{4, 4, 3, 1.4}, {11, 4, 3, 1.4}, {18, 4, 3, 1.4}}, "wall_grey"});
  add_wall(kit, room, "wall_north", {x, y, -x, y, kHeight, {}, "wall_grey"});
  add_wall(kit, room, "wall_west", {-x, y, -x, -y, kHeight, {{4, 4, 3, 1.4}, {17.5, 0, 3.5, 4}}, "wall_grey"});
  for (const double along : {5.5, 12.5, 19.5}) add_window(kit, room, {x, -y + along, 4, 90}, 3, 1.4);
  add_window(kit, room, {-x, y - 5.5, 4, -90}, 3, 1.4);
  add_gate(kit, room, {-x + 7.75, -y, 0, 0}, 3.5, 4);
  add_gate(kit, room, {-x + 15.75, -y, 0, 0}, 3.5, 4);
  add_gate(kit, room, {-x, y - 19.25, 0, -90}, 3.5, 4);
  add_door(kit, room, {6.5, -y, 0, 0}, 1.0, 2.1);
  add_wall_picture(kit, room, {6.5, -y, 2.3, 0}, 0.5, 0.25, "sign_exit");
  add_wall_picture(kit, room, {8.2, -y, 1.4, 0}, 0.6, 0.84, "poster_safety");
  add_wall_picture(kit, room, {9.2, -y, 1.4, 0}, 0.6, 0.84, "poster_lifting");
  add_switch_box(kit, room, {5.2, -y, 1.1, 0});
  add_fire_extinguisher(kit, room, {7.5, -y, 0.55, 0});
  for (const double lamp_x : {-15.0, -7.5, 0.0, 7.5, 15.0}) {
    for (const double lamp_y : {-8.5, -4.0, 4.2, 9.4}) add_ceiling_lamp(kit, room, {lamp_x, lamp_y, kHeight - 0.3, 90}, 60.0);
  }
  for (const double column_x : {-15.0, -5.0, 5.0, 15.0}) {
    add_column(kit, room, {column_x, 3.9}, kHeight);
    add_column(kit, room, {column_x, -10.5}, kHeight);
  }
  add_floor_tape(kit, room, "aisle_south", {{-18.5, 0.4}, {18.5, 0.4}}, 0.10, "yellow_tape");
  add_floor_tape(kit, room, "aisle_north", {{-18.5, 3.0}, {18.5, 3.0}}, 0.10, "yellow_tape");
  add_floor_tape(kit, room, "staging", {{9.5, -4.4}, {18.6, -4.4}, {18.6, -11.0}, {9.5, -11.0}, {9.5, -4.4}}, 0.08, "yellow_tape");
  add_floor_tape(kit, room, "dock_line", {{-14.5, -11.2}, {-2.0, -11.2}}, 0.12, "hazard_tape");
  add_tyre_marks(kit, room, {{-17, 1.6}, {-10, 1.9}, {-2, 1.4}, {6, 1.9}, {13, 1.5}, {17, 0.9}});
  add_tyre_marks(kit, room, {{-12.2, -11.5}, {-12.0, -9.5}, {-11.6, -5.0}, {-11.2, -1.0}, {-9.5, 1.0}, {-6, 1.5}});
  add_tyre_marks(kit, room, {{-9, -0.9}, {-5, -1.1}, {-1, -0.8}, {1.6, -1.2}, {3.2, -3.0}, {3.3, -6}});
}

// The loop: line A along y = -2.5, a curve, a cross segment, a curve, line B along y = -6.14.
void add_conveyor_loop(Kit& kit, int hall) {
  const int loop = kit.group("conveyor_loop", hall);
  const double segment = 1.6, pitch = segment + kGap, radius = 1.0, y_a = -2.5;
  const double end_x = 0.0, x_cross = end_x + kGap + radius;
  const double y_curve_a = y_a - radius, y_curve_b = y_curve_a - 2 * kGap - segment, y_b = y_curve_b - radius;
  for (int i = 0; i < 5; ++i) {
    const double x = end_x - segment / 2 - (4 - i) * pitch;
    add_floor_conveyor(kit, loop, {x, y_a}, {.name = "conveyor_a" + std::to_string(i + 1), .length = segment, .rollers = i != 2});
    add_floor_conveyor(kit, loop, {x, y_b, 0, 180},
                       {.name = "conveyor_b" + std::to_string(i + 1), .length = segment, .rollers = i != 1 && i != 3});
  }
  add_curve_conveyor(kit, loop, {end_x + kGap, y_curve_a, 0, 0}, {.name = "conveyor_curve_a", .radius = radius});
  add_floor_conveyor(kit, loop, {x_cross, y_curve_a - kGap - segment / 2, 0, 90},
                     {.name = "conveyor_cross", .length = segment, .rollers = false});
  add_curve_conveyor(kit, loop, {end_x + kGap, y_curve_b, 0, -90}, {.name = "conveyor_curve_b", .radius = radius, .belt = true});
  // Where goods come from and go to.
  add_signal_tower(kit, loop, {-8.6, y_a, 0.95});
  add_cabinet(kit, loop, {-8.6, y_a, 0, 90}, {.width = 0.6, .depth = 0.5, .height = 0.95});
  add_cabinet(kit, loop, {-8.6, y_b, 0, 90}, {.width = 0.6, .depth = 0.5, .height = 0.95});
  add_control_box(kit, loop, {-8.6, y_b + 0.1, 0.95});
}

// A packing place with two short belts of its own.
void add_packing(Kit& kit, int hall) {
  const int packing = kit.group("packing", hall);
  add_floor_conveyor(kit, packing, {10.5, -1.9, 0, 90},
                     {.name = "conveyor_pack1", .length = 1.2, .width = 0.5, .height = 0.80, .rollers = false});
  add_floor_conveyor(kit, packing, {13.5, -1.9, 0, 90},
                     {.name = "conveyor_pack2", .length = 1.2, .width = 0.5, .height = 0.80, .rollers = true});
  for (const double x : {10.5, 13.5}) {
    add_table(kit, packing, {x + 0.1, -3.05}, {.width = 1.6, .depth = 0.8, .height = 0.85, .top = "beech", .shelf = true});
    add_monitor(kit, packing, {x + 0.55, -3.2, 0.85, 186}, x < 12 ? "screen_status" : "screen_plot");
    add_carton(kit, packing, {x - 0.45, -3.05, 0.85, 10}, 0.40, 0.30, 0.22);
    add_stool(kit, packing, {x + 0.95, -2.2});
    add_waste_bin(kit, packing, {x - 0.95, -3.0});
  }
  add_tools(kit, packing, {10.6, -2.9, 0.85, 20});
  add_trolley(kit, packing, {16.2, -2.4, 0, 80});
  add_shelf(kit, packing, {17.6, -3.2, 0, 180}, 2.0, 2.0);
}

void add_storage(Kit& kit, int hall) {
  const int storage = kit.group("storage", hall);
  const double rack_x = -3.0;
  add_rack(kit, storage, {rack_x, 11.7, 0, 0}, {.bays = 9, .levels = 3, .fill = 0.82, .key = "north"});
  add_rack(kit, storage, {rack_x, 7.45, 0, 180}, {.bays = 9, .levels = 3, .fill = 0.75, .key = "middle back"});
  add_rack(kit, storage, {rack_x, 6.25, 0, 0}, {.bays = 9, .levels = 3, .fill = 0.85, .key = "middle front"});
  for (const double x : {-15.75, 9.75}) {
    add_barrier(kit, storage, {x, 6.85, 0, 90}, 2.4);
    for (const double y : {5.3, 10.8}) add_post(kit, storage, {x, y});
  }
  for (int i = 0; i < 4; ++i) add_hanging_sign(kit, storage, {-12.0 + 7 * i, 4.6, 4.2}, i + 1);
  const RandomStream random(0, "warehouse", "staging");
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto n = static_cast<std::uint64_t>(i * 3 + j);
      if (random.uniform(n, 0) < 0.2) continue;
      add_loaded_pallet(kit, storage, {10.6 + 1.75 * i, -5.6 - 2.1 * j, 0, 90 + 5 * random.uniform(n, 1) - 2.5},
                        static_cast<int>(random.uniform(n, 2) * 4), "staging" + std::to_string(n));
    }
  }
  for (int i = 0; i < 4; ++i) add_loaded_pallet(kit, storage, {14.0 + 1.5 * i, 11.4, 0, 90}, i % 4, "corner" + std::to_string(i));
  for (int i = 0; i < 3; ++i) add_loaded_pallet(kit, storage, {18.9, 5.0 + 1.6 * i, 0, 2.0 * i}, (i + 1) % 3, "east" + std::to_string(i));
  add_trolley(kit, storage, {-17.8, -3.0, 0, 85});
  add_trolley(kit, storage, {-17.9, -4.6, 0, 95});
  add_loaded_pallet(kit, storage, {-17.2, 9.5, 0, 0}, 3, "west a");
  add_loaded_pallet(kit, storage, {-17.2, 11.0, 0, 1}, 1, "west b");
  add_fence(kit, storage, {-14.6, -7.6, 0, 90}, 4.5);
  add_barrier(kit, storage, {-15.6, -1.2, 0, 0}, 3.0);
  add_barrier(kit, storage, {6.6, -8.6, 0, 90}, 4.0);
  for (const double x : {-14.3, -10.2, -6.3, -2.2}) add_post(kit, storage, {x, -11.9});
  add_cabinet(kit, storage, {-19.6, 0.9, 0, 90}, {.width = 1.0, .depth = 0.6, .height = 1.0, .drawers = true});
  add_table(kit, storage, {3.2, -11.5, 0, 180}, {.width = 1.6, .depth = 0.8});
  add_monitor(kit, storage, {3.2, -11.7, 0.75, 180}, "screen_code");
  add_keyboard(kit, storage, {3.2, -11.35, 0.75, 180});
  add_office_chair(kit, storage, {3.1, -10.7, 0, 8}, "fabric_blue");
}

}  // namespace

void build_warehouse(Kit& kit) {
  const int hall = kit.group("warehouse", -1);
  add_room(kit, hall);
  add_conveyor_loop(kit, hall);
  add_packing(kit, hall);
  add_storage(kit, hall);
}

}  // namespace waretwin::builder
