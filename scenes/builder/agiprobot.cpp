#include "scenes/builder/halls.h"
#include "scenes/builder/parts/conveyors.h"
#include "scenes/builder/parts/furniture.h"
#include "scenes/builder/parts/room.h"
#include "scenes/builder/parts/storage.h"

namespace waretwin::builder {
namespace {

constexpr double kLength = 12.0, kWidth = 6.0, kHeight = 3.2;

void add_room(Kit& kit, int hall) {
  const int room = kit.group("room", hall);
  add_floor(kit, room, kLength, kWidth);
  add_ceiling(kit, room, kLength, kWidth, kHeight);
  const double x = kLength / 2, y = kWidth / 2;
  add_wall(kit, room, "wall_south", {-x, -y, x, -y, kHeight, {}});
  add_wall(kit, room, "wall_east", {x, -y, x, y, kHeight, {{4.4, 0, 0.95, 2.05}}});
  add_wall(kit, room, "wall_north", {x, y, -x, y, kHeight, {{1.2, 1.25, 2.0, 1.4}, {5.0, 1.25, 2.0, 1.4}, {8.8, 1.25, 2.0, 1.4}}});
  add_wall(kit, room, "wall_west", {-x, y, -x, -y, kHeight, {{1.6, 0, 2.4, 2.5}}});
  for (const double along : {2.2, 6.0, 9.8}) add_window(kit, room, {x - along, y, 1.25, 180}, 2.0, 1.4);
  add_door(kit, room, {x, -y + 4.4 + 0.475, 0, 90}, 0.95, 2.05);
  add_gate(kit, room, {-x, y - 1.6 - 1.2, 0, -90}, 2.4, 2.5);
  add_wall_picture(kit, room, {x, 1.875, 2.2, 90}, 0.36, 0.18, "sign_exit");

  add_cable_duct(kit, room, {-2.6, -y, 1.0, 0}, 5.6);
  add_cable_duct(kit, room, {3.0, -y, 1.0, 0}, 5.4);
  add_cable_duct(kit, room, {0, y, 1.0, 180}, 11.0);
  add_radiator(kit, room, {-3.8, y, 0, 180}, 1.6);
  add_radiator(kit, room, {3.8, y, 0, 180}, 1.6);
  add_wall_picture(kit, room, {-0.1, -y, 1.35, 0}, 0.84, 1.19, "poster_project");
  add_wall_picture(kit, room, {-3.2, -y, 1.4, 0}, 0.6, 0.84, "poster_safety");
  add_wall_picture(kit, room, {3.1, -y, 1.4, 0}, 0.6, 0.84, "poster_lifting");
  add_wall_picture(kit, room, {x, -0.1, 1.2, 90}, 1.5, 1.0, "whiteboard");
  add_wall_picture(kit, room, {-x, -2.0, 2.3, -90}, 0.32, 0.32, "clock");
  add_switch_box(kit, room, {-4.9, -y, 1.1, 0});
  add_fire_extinguisher(kit, room, {5.4, -y, 0.55, 0});

  for (const double lamp_x : {-4.0, 0.0, 4.0}) {
    for (const double lamp_y : {-1.3, 1.3}) add_ceiling_lamp(kit, room, {lamp_x, lamp_y, kHeight - 0.064}, 14.0);
  }

  add_floor_tape(kit, room, "lane_outer", {{-3.75, -1.53}, {3.75, -1.53}, {3.75, 1.53}, {-3.75, 1.53}, {-3.75, -1.53}}, 0.06,
                 "yellow_tape");
  add_floor_tape(kit, room, "lane_inner", {{-2.3, -0.38}, {2.3, -0.38}, {2.3, 0.38}, {-2.3, 0.38}, {-2.3, -0.38}}, 0.06, "yellow_tape");
  add_floor_tape(kit, room, "gate_line", {{-5.2, -0.9}, {-5.2, 1.5}}, 0.10, "hazard_tape");
  add_tyre_marks(kit, room, {{-5.0, 0.35}, {-4.2, -0.2}, {-3.4, -0.85}, {-2.0, -0.78}, {0.5, -0.8}, {2.2, -0.72}, {3.0, -0.2}, {2.9, 0.7}});
  add_tyre_marks(kit, room, {{3.1, 1.25}, {1.8, 1.22}, {0.0, 1.28}, {-1.8, 1.24}, {-2.9, 1.2}, {-3.3, 0.4}, {-3.2, -0.6}});
  add_tyre_marks(kit, room, {{-2.3, -1.2}, {-2.05, -1.35}, {-1.85, -1.58}});
  add_tyre_marks(kit, room, {{1.2, 1.3}, {1.5, 1.42}, {1.7, 1.6}});
}

// A station in its own frame: the cabinet's middle on the floor is the origin, the vehicle comes from -y.
struct Station {
  int number;
  double x, y, yaw_deg;
  TableTopConveyor conveyor;
  // No whole degrees: the mapper searches headings in such steps, and must not be flattered by the hall.
  double conveyor_x, conveyor_yaw_deg;
};

int add_station(Kit& kit, int hall, const Station& s) {
  const std::string name = "station_" + std::to_string(s.number);
  const int station = kit.group(name, hall, {s.x, s.y, 0, s.yaw_deg});
  const Cabinet cabinet{.drawers = s.number % 2 == 0};
  add_cabinet(kit, station, {}, cabinet);
  // Front edge of the cabinet at -0.35; the conveyor stands 5 cm behind it.
  TableTopConveyor conveyor = s.conveyor;
  conveyor.name = "conveyor_" + std::to_string(s.number);
  add_table_top_conveyor(kit, station, {s.conveyor_x, -0.09, cabinet.height, s.conveyor_yaw_deg}, conveyor);
  kit.place(name + "_sign", station, {0.27, -0.3545, 0.55}, "station_sign_" + std::to_string(s.number), [&](MeshDraft& draft) {
    draft.add(kit.material("marker_" + std::to_string(s.number)), picture({-0.06, 0, 0}, {0.12, 0, 0}, {0, 0, 0.12}));
  });
  add_floor_tape(kit, station, name + "_dock", {{-0.40, -0.41}, {0.40, -0.41}}, 0.06, "hazard_tape");
  return station;
}

void add_station_1(Kit& kit, int hall) {
  const int s = add_station(kit, hall, {1, -1.7, -2.03, 180, {.length = 0.60, .width = 0.40, .height = 0.15}, 0.0, 3.37});
  add_table(kit, s, {-0.87, 0.02, 0, 0}, {.width = 0.8, .depth = 0.7, .shelf = true});
  add_robot_arm(kit, s, {-0.80, 0.10, 0.75, 0}, {.base_deg = -25, .shoulder_deg = 18, .elbow_deg = 82, .wrist_deg = 70});
  add_bin(kit, s, {-1.10, -0.17, 0.75, -8}, 0.22, 0.32, 0.14, "bin_green", true);
  add_toolbox(kit, s, {-0.95, 0.0, 0.2, 12});
  add_bin(kit, s, {0.27, 0.27, 0.75, 3}, 0.20, 0.12, 0.09, "bin_green");
  add_control_box(kit, s, {-0.30, 0.27, 0.75, 0});
  add_cable(kit, s, "cable_1a",
            {{-0.30, 0.31, 0.77},
             {-0.2, 0.36, 0.76},
             {-0.18, 0.40, 0.5},
             {-0.1, 0.5, 0.05},
             {-0.12, 0.7, 0.05},
             {-0.1, 0.80, 0.6},
             {-0.1, 0.92, 1.02}},
            0.006, "cable_black");
  add_cable(kit, s, "cable_1b",
            {{-0.80, 0.19, 0.78}, {-0.7, 0.36, 0.76}, {-0.66, 0.41, 0.4}, {-0.6, 0.6, 0.03}, {-0.5, 0.8, 0.3}, {-0.5, 0.92, 1.02}}, 0.007,
            "cable_grey");
  add_leaning_panel(kit, s, {0.505, 0.05, 0, 90}, 0.55, 0.62, 0.016, 9, "birch");
  add_leaning_panel(kit, s, {0.545, 0.08, 0, 90}, 0.45, 0.50, 0.012, 10, "chipboard");
  add_bin(kit, s, {0.85, 0.2, 0, 15}, 0.40, 0.30, 0.22, "bin_green", true);
}

void add_station_2(Kit& kit, int hall) {
  const int s = add_station(kit, hall, {2, 1.5, -2.05, 180, {.length = 0.64, .width = 0.40, .height = 0.15, .rollers = true}, 0.0, -4.41});
  add_table(kit, s, {-0.95, 0.05, 0, 2}, {.width = 0.9, .depth = 0.65, .top = "beech"});
  add_monitor(kit, s, {-0.95, 0.17, 0.75, -14}, "screen_status");
  add_keyboard(kit, s, {-0.98, -0.12, 0.75, -6});
  add_cup(kit, s, {-1.28, 0.0, 0.75, 40});
  add_signal_tower(kit, s, {-0.33, 0.28, 0.75, 0});
  add_tools(kit, s, {0.20, 0.27, 0.75, 182});
  add_cable(kit, s, "cable_2a",
            {{0.28, 0.17, 0.757}, {0.36, 0.30, 0.757}, {0.33, 0.40, 0.6}, {0.36, 0.6, 0.1}, {0.3, 0.8, 0.5}, {0.3, 0.92, 1.02}}, 0.006,
            "cable_yellow");
  add_cable(kit, s, "cable_2b", {{-0.95, 0.3, 0.80}, {-0.9, 0.41, 0.7}, {-0.8, 0.55, 0.2}, {-0.8, 0.8, 0.5}, {-0.8, 0.92, 1.02}}, 0.005,
            "cable_black");
  add_leaning_panel(kit, s, {0.50, 0.0, 0, 90}, 0.60, 0.60, 0.018, 8.5, "beech");
  add_stool(kit, s, {-0.95, -0.02 + 0.65, 0, 0});
  add_bin(kit, s, {0.95, 0.25, 0, -12}, 0.40, 0.30, 0.22, "bin_blue");
  add_bin(kit, s, {0.95, 0.25, 0.22, -8}, 0.40, 0.30, 0.22, "bin_green", true);
}

void add_station_3(Kit& kit, int hall) {
  const int s = add_station(kit, hall, {3, 1.8, 2.03, 0, {.length = 0.58, .width = 0.38, .height = 0.15}, -0.01, 4.63});
  add_cabinet(kit, s, {-0.86, 0.03, 0, -1}, {.width = 0.8, .depth = 0.6, .height = 0.75, .drawers = true});
  add_robot_arm(kit, s, {-0.83, 0.12, 0.75, 0}, {.base_deg = -60, .shoulder_deg = -12, .elbow_deg = 110, .wrist_deg = 55});
  add_bin(kit, s, {-1.09, -0.12, 0.75, 6}, 0.20, 0.28, 0.12, "bin_green", true);
  add_bin(kit, s, {-0.02, 0.28, 0.75, -2}, 0.22, 0.12, 0.10, "bin_green");
  add_bin(kit, s, {0.24, 0.28, 0.75, 1}, 0.22, 0.12, 0.10, "bin_red");
  add_control_box(kit, s, {-0.31, 0.26, 0.75, -10});
  add_monitor_stand(kit, s, {-1.55, 0.15, 0, -12}, "screen_plot", 1.45);
  add_cable(kit, s, "cable_3a",
            {{-0.31, 0.30, 0.77}, {-0.25, 0.37, 0.74}, {-0.26, 0.5, 0.2}, {-0.2, 0.7, 0.05}, {-0.2, 0.82, 0.5}, {-0.2, 0.92, 1.02}}, 0.006,
            "cable_black");
  add_cable(kit, s, "cable_3b", {{-1.55, 0.24, 0.7}, {-1.5, 0.4, 0.2}, {-1.35, 0.6, 0.02}, {-1.2, 0.8, 0.4}, {-1.2, 0.92, 1.02}}, 0.006,
            "cable_blue");
  add_leaning_panel(kit, s, {0.50, 0.02, 0, 90}, 0.50, 0.55, 0.018, 9, "chipboard");
  add_leaning_panel(kit, s, {0.54, 0.0, 0, 90}, 0.58, 0.48, 0.012, 10.5, "birch");
  add_waste_bin(kit, s, {0.85, 0.22, 0, 0});
}

void add_station_4(Kit& kit, int hall) {
  const int s = add_station(kit, hall, {4, -1.5, 2.05, 0, {.length = 0.62, .width = 0.42, .height = 0.16, .rollers = true}, 0.01, -6.58});
  add_table(kit, s, {-0.92, 0.05, 0, -2}, {.width = 0.9, .depth = 0.7});
  add_laptop(kit, s, {-0.85, 0.0, 0.75, 18});
  add_book_stack(kit, s, {-1.2, 0.15, 0.75, 25});
  add_robot_arm(kit, s, {-0.60, 0.25, 0.75, 0}, {.base_deg = -140, .shoulder_deg = 5, .elbow_deg = 95, .wrist_deg = 60, .gripper = false});
  add_bin(kit, s, {0.26, 0.29, 0.75, 0}, 0.20, 0.11, 0.09, "bin_green", true);
  add_signal_tower(kit, s, {-0.35, 0.29, 0.75, 0});
  add_cable(kit, s, "cable_4a",
            {{-0.32, 0.29, 0.76}, {-0.2, 0.31, 0.757}, {-0.1, 0.37, 0.73}, {-0.1, 0.5, 0.2}, {-0.2, 0.8, 0.4}, {-0.2, 0.92, 1.02}}, 0.006,
            "cable_grey");
  add_cable(kit, s, "cable_4b", {{-0.60, 0.34, 0.78}, {-0.58, 0.42, 0.7}, {-0.5, 0.6, 0.1}, {-0.6, 0.8, 0.4}, {-0.6, 0.92, 1.02}}, 0.007,
            "cable_black");
  add_leaning_panel(kit, s, {0.505, -0.03, 0, 90}, 0.48, 0.64, 0.018, 9, "birch");
  add_bin(kit, s, {0.90, 0.22, 0, 8}, 0.40, 0.30, 0.22, "bin_green");
  add_bin(kit, s, {0.90, 0.22, 0.22, 3}, 0.40, 0.30, 0.22, "bin_green", true);
}

void add_surroundings(Kit& kit, int hall) {
  const int east = kit.group("desks", hall);
  add_table(kit, east, {5.55, -1.55, 0, -90}, {.width = 1.6, .depth = 0.75});
  add_monitor(kit, east, {5.70, -1.25, 0.75, -82}, "screen_code");
  add_monitor(kit, east, {5.68, -1.88, 0.75, -101}, "screen_plot");
  add_keyboard(kit, east, {5.42, -1.5, 0.75, -88});
  add_cup(kit, east, {5.45, -2.05, 0.75, 10});
  add_office_chair(kit, east, {4.72, -1.53, 0, 112}, "fabric_black");
  add_table(kit, east, {5.55, 0.2, 0, -90}, {.width = 1.4, .depth = 0.75, .top = "beech"});
  add_laptop(kit, east, {5.48, 0.35, 0.75, -78});
  add_book_stack(kit, east, {5.6, -0.2, 0.75, 14});
  add_office_chair(kit, east, {4.75, 0.35, 0, 78}, "fabric_blue");
  add_plant(kit, east, {5.6, 2.62, 0, 0});
  add_waste_bin(kit, east, {5.7, -2.6, 0, 0});

  const int west = kit.group("stores", hall);
  add_shelf(kit, west, {-5.72, -1.7, 0, 90}, 1.6, 1.9);
  add_shelf(kit, west, {-4.9, 2.74, 0, 0}, 1.4, 1.1);
  add_pallet(kit, west, {-4.55, -2.4, 0, 4});
  add_carton_stack(kit, west, {-4.55, -2.4, kPalletHeight, 4}, 3, 2, 2, 0.36, 0.36, 0.28, "agiprobot");
  add_trolley(kit, west, {-3.55, -2.45, 0, 3});
  add_table(kit, west, {-3.75, 2.5, 0, 0}, {.width = 1.0, .depth = 0.6, .top = "table_top", .shelf = true});
  add_bin(kit, west, {-3.95, 2.5, 0.75, 4}, 0.30, 0.40, 0.18, "bin_green", true);
  add_bin(kit, west, {-3.58, 2.5, 0.75, -3}, 0.30, 0.40, 0.18, "bin_blue");
  add_bin(kit, west, {-3.75, 2.5, 0.2, 0}, 0.40, 0.30, 0.22, "bin_green");
  add_office_chair(kit, west, {-4.55, 1.75, 0, 215}, "fabric_black");
  add_leaning_panel(kit, west, {-2.75, -2.82, 0, 180}, 0.9, 1.25, 0.018, 8, "birch");
  add_leaning_panel(kit, west, {-2.65, -2.76, 0, 182}, 0.7, 1.0, 0.018, 9, "chipboard");
  add_leaning_panel(kit, east, {0.05, 2.84, 0, 0}, 0.8, 0.95, 0.018, 8, "beech");
  add_table(kit, east, {3.6, 2.5, 0, 0}, {.width = 1.2, .depth = 0.65});
  add_monitor(kit, east, {3.5, 2.62, 0.75, 8}, "screen_status");
  add_keyboard(kit, east, {3.5, 2.38, 0.75, 4});
  add_tools(kit, east, {3.98, 2.45, 0.75, 30});
  add_office_chair(kit, east, {4.45, 2.15, 0, -40}, "fabric_black");
  add_cabinet(kit, east, {3.35, -2.55, 0, 180}, {.width = 0.9, .depth = 0.6, .height = 0.9});
  add_toolbox(kit, east, {3.3, -2.55, 0.9, 172});
  add_bin(kit, east, {3.66, -2.6, 0.9, 184}, 0.2, 0.28, 0.12, "bin_green", true);
  add_pallet(kit, east, {4.6, -2.45, 0, 88});
  add_carton_stack(kit, east, {4.6, -2.45, kPalletHeight, 88}, 2, 2, 1, 0.5, 0.36, 0.34, "agiprobot east");
}

}  // namespace

void build_agiprobot(Kit& kit) {
  const int hall = kit.group("agiprobot", -1);
  add_room(kit, hall);
  add_station_1(kit, hall);
  add_station_2(kit, hall);
  add_station_3(kit, hall);
  add_station_4(kit, hall);
  add_surroundings(kit, hall);
}

}  // namespace waretwin::builder
