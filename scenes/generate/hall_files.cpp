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

// What of the drive is not as usual.
std::string drive_text(const DriveConfig& drive) {
  const DriveConfig usual;
  if (drive.mass_kg == usual.mass_kg && drive.track_m == usual.track_m) return {};
  return "  drive: {mass_kg: " + number(drive.mass_kg) + ", track_m: " + number(drive.track_m) + "}\n";
}

}  // namespace

std::string build_glb(const HallPlan& plan) {
  Kit kit;
  for (const auto& [name, finish] : plan.finishes) kit.define(name, finish);
  const int hall = kit.group(plan.name, -1);
  build_room(kit, hall, plan);
  for (const PlannedObject& object : plan.objects) add_planned_object(kit, hall, object);
  const int things = kit.group("things", hall);
  for (const PlacedItem& item : plan.items) item.item.add(kit, things, item.at);
  return kit.model.to_glb(plan.name);
}

std::string scenario_text(const HallPlan& plan, std::uint64_t seed) {
  const RobotConfig& r = plan.robot;
  std::string text =
      "# " + plan.title + " of " + number(plan.length) + " x " + number(plan.width) + " m with " + std::to_string(plan.objects.size()) +
      " " + plan.what +
      ", made by `waretwin generate`.\n"
      "# Lengths are metres, angles degrees. The world's z axis points up; its origin is the middle of the hall's floor. Keys not named "
      "here\n"
      "# keep their defaults; `waretwin inspect FILE --keys` shows all of them.\n"
      "name: " +
      plan.name + "\ndescription: " + plan.description +
      "\n\n"
      "# Reseeds the sensors' errors and the wheels' slip. The hall itself never changes with it.\nseed: " +
      std::to_string(seed) +
      "\n\n"
      "# Nodes of hall.glb that carry {\"waretwin\": {\"class\": \"" +
      (plan.what == "conveyors" ? "conveyor" : "...") +
      "\"}} in their extras are the true objects.\n"
      "models:\n  - file: hall.glb\n\n"
      "# hall.glb brings its lamps; this is the light that comes from everywhere else.\n"
      "lighting:\n  ambient: " +
      numbers(plan.lighting.ambient) + "\n  background: " + numbers(plan.lighting.background) +
      "\n  exposure: " + number(plan.lighting.exposure) +
      "\n\n"
      "robot:\n  length_m: " +
      number(r.length_m) + "\n  width_m: " + number(r.width_m) + "\n  height_m: " + number(r.height_m) +
      "\n  speed_mps: " + number(r.speed_mps) + "\n  acceleration_mps2: " + number(r.acceleration_mps2) +
      "\n  turn_rate_deg_s: " + number(r.turn_rate_deg_s) + "\n  turn_acceleration_deg_s2: " + number(r.turn_acceleration_deg_s2) + "\n" +
      drive_text(r.drive) +
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
      text += "  # " + plan.objects[static_cast<std::size_t>(plan.stops[next_stop].object)].name;
      ++next_stop;
    }
    text += "\n";
  }
  return text + "\n" + plan.sensors;
}

}  // namespace waretwin::generate
