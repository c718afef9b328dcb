// What stands about in a cell: cabinets, tables, chairs, screens, robot arms, bins, panels, tools, cables.
#pragma once

#include <string>
#include <vector>

#include "scenes/builder/kit.h"

namespace waretwin::builder {

// A dark-grey cabinet on feet; its front looks to -y. Returns the node; its top is at `height`.
struct Cabinet {
  double width = 0.80, depth = 0.70, height = 0.75;
  bool drawers = false;
};
int add_cabinet(Kit& kit, int parent, const Placement& at, const Cabinet& c);

// A table on four legs, seen from the side of -y.
struct Table {
  double width = 1.2, depth = 0.7, height = 0.75;
  std::string top = "table_top";
  bool shelf = false;
};
int add_table(Kit& kit, int parent, const Placement& at, const Table& t);

// A six-axis arm with light-blue joint caps, about 0.5 m of reach, its base on the placement. Angles in degrees: base, shoulder
// (0 = upright, positive leans to +x), elbow and wrist relative to the link before.
struct RobotArm {
  double base_deg = 0, shoulder_deg = 20, elbow_deg = 80, wrist_deg = 60;
  bool gripper = true;
};
int add_robot_arm(Kit& kit, int parent, const Placement& at, const RobotArm& arm);

// An open stacking bin with sloped front (to -y).
int add_bin(Kit& kit, int parent, const Placement& at, double length, double width, double height, const std::string& finish,
            bool filled = false);

int add_monitor(Kit& kit, int parent, const Placement& at, const std::string& screen);                       // on its foot; looks to -y
int add_monitor_stand(Kit& kit, int parent, const Placement& at, const std::string& screen, double height);  // on a pole from the floor
int add_keyboard(Kit& kit, int parent, const Placement& at);                                                 // with a mouse
int add_office_chair(Kit& kit, int parent, const Placement& at, const std::string& fabric);                  // seat looks to -y
int add_stool(Kit& kit, int parent, const Placement& at);

// A board that leans: it stands on the placement along x and leans towards +y by `lean_deg`.
int add_leaning_panel(Kit& kit, int parent, const Placement& at, double width, double height, double thickness, double lean_deg,
                      const std::string& finish);

int add_cable(Kit& kit, int parent, const std::string& name, const std::vector<Vector3d>& points, double radius, const std::string& finish);

int add_tools(Kit& kit, int parent, const Placement& at);  // screwdrivers, a wrench, a small box; lies on a top, 0.3 x 0.2 m
int add_toolbox(Kit& kit, int parent, const Placement& at);
int add_cup(Kit& kit, int parent, const Placement& at);
int add_book_stack(Kit& kit, int parent, const Placement& at);
int add_laptop(Kit& kit, int parent, const Placement& at);  // looks to -y
int add_waste_bin(Kit& kit, int parent, const Placement& at);
int add_plant(Kit& kit, int parent, const Placement& at);
int add_shelf(Kit& kit, int parent, const Placement& at, double width, double height);  // open shelf with boxes and bins; front to -y
int add_control_box(Kit& kit, int parent, const Placement& at);                         // with an emergency stop, for a top
int add_trolley(Kit& kit, int parent, const Placement& at);
int add_signal_tower(Kit& kit, int parent, const Placement& at);  // three lamps on a pole, 0.45 m high

}  // namespace waretwin::builder
