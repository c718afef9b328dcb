// A hall on paper: where everything stands and where the vehicle drives, before anything is built.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenes/builder/kit.h"
#include "scenes/builder/parts/room.h"
#include "scenes/generate/planned_object.h"
#include "scenes/generate/solid.h"
#include "scenes/scenario.h"

namespace waretwin::generate {

// Anything that is no true object: how it is built, and its box in its own frame.
struct Item {
  std::function<void(builder::Kit& kit, int parent, const builder::Placement& at)> add;
  Eigen::AlignedBox3d extent;
};
// Measures the box on the part itself.
Item make_item(std::function<void(builder::Kit&, int, const builder::Placement&)> add);

struct PlacedItem {
  Item item;
  builder::Placement at;
};

struct FloorMark {
  std::vector<Eigen::Vector2d> path;
  double width = 0.06;
  std::string finish;  // empty: tyre marks
};

struct PlannedOpening {
  enum class Kind { kWindow, kDoor, kGate };
  Kind kind = Kind::kWindow;
  builder::Opening hole;
};

// One of the room's four walls.
struct PlannedWall {
  std::string name;
  Eigen::Vector2d from, to;  // the room is on the left
  std::vector<PlannedOpening> openings;
  double length() const { return (to - from).norm(); }
  double yaw_deg() const;
  // `along` metres from the wall's start, `off` metres into the room, looking along the wall: +y points into the room.
  builder::Placement at(double along, double off, double z) const;
};

// A place where the vehicle stops to look.
struct Stop {
  Eigen::Vector2d place;
  double heading_deg = 0.0;
  int object = 0;  // index of what it looks at
};

struct HallPlan {
  std::string name, title, description;
  std::string what = "conveyors";                                    // its objects are
  double length = 0.0, width = 0.0, height = 3.2;                    // of the room, its floor's middle at the origin, its length along x
  std::map<std::string, std::function<builder::Finish()>> finishes;  // of this hall's own
  std::string floor = "concrete_floor", wall = "wall_paint";
  std::vector<PlannedWall> walls;  // south, east, north, west
  Eigen::Vector2d entrance = Eigen::Vector2d::Zero();
  std::vector<builder::Placement> lamps;
  double lamp_cd = 14.0;
  LightingConfig lighting;
  std::vector<PlannedObject> objects;
  std::vector<PlacedItem> items;
  std::vector<FloorMark> marks;
  std::vector<Solid> solids;     // of all items and objects
  std::vector<Solid> kept_free;  // where nothing may be put
  RobotConfig robot;             // with the route
  std::string sensors;           // what the vehicle carries, as its scenario says it (vehicle.h)
  std::vector<Stop> stops;       // in the order of the route

  // Whether a solid may stand there: within the walls by `margin`, off what stands there by `margin`, and off what is kept free.
  bool fits(const Solid& solid, double margin, bool may_take_free_space = false) const;
  void add(const Item& item, const builder::Placement& at);
  // Adds the item where it fits; false where it does not.
  bool try_add(const Item& item, const builder::Placement& at, double margin);
};

}  // namespace waretwin::generate
