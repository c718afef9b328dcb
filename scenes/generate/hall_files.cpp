#include "scenes/generate/hall_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace waretwin::generate {

namespace {

using builder::Kit;

void build_room(Kit& kit, int hall, const HallPlan& plan) {
  const int room = kit.group("room", hall);
  builder::add_floor(kit, room, plan.length, plan.width, plan.floor);
  builder::add_ceiling(kit, room, plan.length, plan.width, plan.height);
  for (const PlannedWall& wall : plan.walls) {
    std::vector<builder::Opening> holes;
    for (const PlannedOpening& o : wall.openings) holes.push_back(o.hole);
    builder::add_wall(kit, room, wall.name, {wall.from.x(), wall.from.y(), wall.to.x(), wall.to.y(), plan.height, holes, plan.wall});
    for (const PlannedOpening& o : wall.openings) {
      const builder::Placement at = wall.at(o.hole.along + o.hole.width / 2, 0, o.hole.above);
      switch (o.kind) {
        case PlannedOpening::Kind::kWindow:
          builder::add_window(kit, room, at, o.hole.width, o.hole.height);
          break;
        case PlannedOpening::Kind::kDoor:
          builder::add_door(kit, room, at, o.hole.width, o.hole.height);
          break;
        case PlannedOpening::Kind::kGate:
          builder::add_gate(kit, room, at, o.hole.width, o.hole.height);
          break;
      }
    }
  }
  for (const builder::Placement& lamp : plan.lamps) builder::add_ceiling_lamp(kit, room, lamp, plan.lamp_cd);
  int tapes = 0;
  for (const FloorMark& mark : plan.marks) {
    if (mark.finish.empty()) {
      builder::add_tyre_marks(kit, room, mark.path);
    } else {
      builder::add_floor_tape(kit, room, "tape_" + std::to_string(++tapes), mark.path, mark.width, mark.finish);
    }
  }
}

// Without zeros at the end: "1.5", "-90", "0".
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  std::string s = text;
  s.erase(s.find_last_not_of('0') + 1);
  if (s.back() == '.') s.pop_back();
  return s == "-0" ? "0" : s;
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number(value);
  return "[" + text + "]";
}

}  // namespace

std::string build_glb(const HallPlan& plan) {
  Kit kit;
  for (const auto& [name, finish] : plan.finishes) kit.define(name, finish);
  const int hall = kit.group(plan.name, -1);
  build_room(kit, hall, plan);
  for (const PlannedConveyor& conveyor : plan.conveyors) add_conveyor(kit, hall, conveyor);
  const int things = kit.group("things", hall);
  for (const PlacedItem& item : plan.items) item.item.add(kit, things, item.at);
  return kit.model.to_glb(plan.name);
}

std::string scenario_text(const HallPlan& plan, std::uint64_t seed) {
  const RobotConfig& r = plan.robot;
  std::string text =
      "# " + plan.title + " of " + number(plan.length) + " x " + number(plan.width) + " m with " + std::to_string(plan.conveyors.size()) +
      " conveyors, made by `waretwin generate`.\n"
      "# Lengths are metres, angles degrees. The world's z axis points up; its origin is the middle of the hall's floor. Keys not named "
      "here\n"
      "# keep their defaults; `waretwin inspect FILE --keys` shows all of them.\n"
      "name: " +
      plan.name + "\ndescription: " + plan.description +
      "\n\n"
      "# Reseeds the sensors' errors and the wheels' slip. The hall itself never changes with it.\nseed: " +
      std::to_string(seed) +
      "\n\n"
      "# Nodes of hall.glb that carry {\"waretwin\": {\"class\": \"conveyor\"}} in their extras are the true objects.\n"
      "models:\n  - file: hall.glb\n\n"
      "# hall.glb brings its lamps; this is the light that comes from everywhere else.\n"
      "lighting:\n  ambient: " +
      numbers(plan.lighting.ambient) + "\n  background: " + numbers(plan.lighting.background) +
      "\n  exposure: " + number(plan.lighting.exposure) +
      "\n\n"
      "robot:\n  length_m: " +
      number(r.length_m) + "\n  width_m: " + number(r.width_m) + "\n  height_m: " + number(r.height_m) +
      "\n  speed_mps: " + number(r.speed_mps) + "\n  acceleration_mps2: " + number(r.acceleration_mps2) +
      "\n  turn_rate_deg_s: " + number(r.turn_rate_deg_s) + "\n  turn_acceleration_deg_s2: " + number(r.turn_acceleration_deg_s2) +
      "\n"
      "  # Places in order. The vehicle turns towards the next one, drives there straight, turns to heading_deg if given, and waits "
      "wait_s.\n"
      "  route:\n";
  std::size_t next_stop = 0;
  for (const Waypoint& w : r.route) {
    text += "    - {x_m: " + number(w.x_m) + ", y_m: " + number(w.y_m);
    if (w.heading_deg) text += ", heading_deg: " + number(*w.heading_deg);
    if (w.wait_s > 0) text += ", wait_s: " + number(w.wait_s);
    if (w.reverse) text += ", reverse: true";
    text += "}";
    if (next_stop < plan.stops.size() && w.heading_deg && plan.stops[next_stop].place == Eigen::Vector2d(w.x_m, w.y_m)) {
      text += "  # " + plan.conveyors[static_cast<std::size_t>(plan.stops[next_stop].conveyor)].name;
      ++next_stop;
    }
    text += "\n";
  }
  return text +
         "\n# The vehicle's sensors by name. A preset stands for a product's data sheet; any of its values can be set beside it.\n"
         "sensors:\n  cameras:\n    camera:\n      preset: azure_kinect\n      rate_hz: 15\n"
         "      # On the vehicle's centre, 1.4 m high, looking forward and 45 degrees down.\n"
         "      mount: {x_m: 0.0, y_m: 0.0, z_m: 1.4, pitch_deg: 45}\n"
         "  lasers:\n    laser:\n      preset: sick_s300\n"
         "      # At the front left corner, level, 0.3 m above the floor.\n"
         "      mount: {x_m: 0.275, y_m: 0.2, z_m: 0.3, yaw_deg: 43.9}\n"
         "  odometry:\n    rate_hz: 50\n";
}

}  // namespace waretwin::generate
