#include "scenes/generate/room_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/builder/finishes.h"

namespace waretwin::generate {

namespace {

using builder::Kit;
using builder::Placement;
using Eigen::Vector3d;

struct Paint {
  Vector3d colour;
  double reflectivity;
};

Vector3d shaded(const Vector3d& colour, Dice& dice, double spread) {
  const double light = dice.between(1 - spread, 1 + spread);
  Vector3d c;
  for (int k = 0; k < 3; ++k) c[k] = std::clamp(colour[k] * light + dice.between(-0.25, 0.25) * spread, 0.03, 0.97);
  return c;
}

double near_to(double value, Dice& dice, double spread) {
  return std::round(std::clamp(value * dice.between(1 - spread, 1 + spread), 0.05, 0.9) * 100) / 100;
}

void draw_openings(PlannedWall& wall, double height, bool entrance, Dice& dice) {
  using Kind = PlannedOpening::Kind;
  double along = dice.between(0.5, 1.5);
  const double rest = dice.between(0.6, 2.2);  // between openings
  bool entrance_made = !entrance;
  const bool windows = dice.chance(0.55);
  while (true) {
    PlannedOpening o;
    if (!entrance_made && (dice.chance(0.5) || !windows)) {
      const bool gate = height > 2.8 && wall.length() > 4.5 && dice.chance(0.5);
      o.kind = gate ? Kind::kGate : Kind::kDoor;
      o.hole = {along, 0, gate ? to_mm(dice.between(2.2, 3.0)) : 0.95, gate ? to_mm(std::min(height - 0.3, dice.between(2.3, 3.0))) : 2.05};
      entrance_made = true;
    } else {
      const double sill = to_mm(dice.between(1.15, 1.4));
      o.hole = {along, sill, to_mm(dice.between(1.2, 2.4)), to_mm(std::min(height - sill - 0.35, dice.between(1.0, 1.5)))};
    }
    if (along + o.hole.width > wall.length() - 0.4) break;
    if (o.kind != Kind::kWindow || windows) wall.openings.push_back(o);
    along = to_mm(along + o.hole.width + rest * dice.between(0.7, 1.3));
  }
  for (PlannedOpening& o : wall.openings) o.hole.along = to_mm(o.hole.along);
}

// Hangs a thing somewhere on a wall, off openings and what stands before it.
void hang(HallPlan& plan, const PlannedWall& wall, double z, double half_width, const Item& item, Dice& dice) {
  constexpr int kTries = 6;
  for (int i = 0; i < kTries; ++i) {
    const double along = dice.between(half_width + 0.2, wall.length() - half_width - 0.2);
    const bool in_opening = std::any_of(wall.openings.begin(), wall.openings.end(), [&](const PlannedOpening& o) {
      return std::abs(along - o.hole.along - o.hole.width / 2) < half_width + o.hole.width / 2 + 0.15;
    });
    if (in_opening) continue;
    const Placement at = wall.at(to_mm(along), 0, z);
    Solid solid = solid_of(item.extent, at);
    // Its back is in the wall; what counts is what reaches into the room.
    const double out = item.extent.max().y();
    const Placement middle = wall.at(to_mm(along), 0.03 + out / 2, z);
    solid.centre = {middle.x, middle.y};
    solid.half.y() = out / 2;
    if (std::any_of(plan.solids.begin(), plan.solids.end(), [&](const Solid& s) { return collide(solid, s, 0.02); })) continue;
    plan.items.push_back({item, at});
    plan.solids.push_back(solid);
    return;
  }
}

}  // namespace

void draw_room(HallPlan& plan, double length, double width, double height, Dice& dice) {
  plan.length = length;
  plan.width = width;
  plan.height = height;
  const double x = length / 2, y = width / 2;
  plan.walls = {{"wall_south", {-x, -y}, {x, -y}, {}},
                {"wall_east", {x, -y}, {x, y}, {}},
                {"wall_north", {x, y}, {-x, y}, {}},
                {"wall_west", {-x, y}, {-x, -y}, {}}};
  const int entrance = dice.whole(0, 3);
  std::optional<Eigen::Vector2d> door;
  for (int i = 0; i < 4; ++i) {
    PlannedWall& wall = plan.walls[static_cast<std::size_t>(i)];
    draw_openings(wall, height, i == entrance || dice.chance(0.2), dice);
    for (const PlannedOpening& o : wall.openings) {
      if (o.kind == PlannedOpening::Kind::kWindow) continue;
      const double depth = o.kind == PlannedOpening::Kind::kGate ? 1.4 : 1.0;
      const Placement middle = wall.at(o.hole.along + o.hole.width / 2, depth / 2, 0);
      const Vector3d half(o.hole.width / 2, depth / 2, 0);
      plan.kept_free.push_back(solid_of({-half, half + Vector3d(0, 0, 3)}, middle));
      if (!door) door = Eigen::Vector2d(middle.x, middle.y);
    }
  }

  // Lamps in rows, every 3 to 4 metres.
  const double pitch = dice.between(2.9, 4.2) * std::max(1.0, height / 4.0);
  const int columns = std::max(2, static_cast<int>(std::lround(length / pitch))),
            rows = std::max(2, static_cast<int>(std::lround(width / pitch)));
  const bool across = dice.chance(0.4);
  for (int i = 0; i < columns; ++i) {
    for (int k = 0; k < rows; ++k) {
      plan.lamps.push_back(
          {to_mm(((i + 0.5) / columns - 0.5) * length), to_mm(((k + 0.5) / rows - 0.5) * width), height - 0.064, across ? 90.0 : 0.0});
    }
  }
  const double per_lamp = length * width / (columns * rows);
  plan.lamp_cd = std::round(14.0 * std::pow(height / 3.2, 2) * std::sqrt(per_lamp / 12.0) * dice.between(0.7, 1.35) * 10) / 10;
  const double ambient = dice.between(0.22, 0.38), warm = dice.between(-0.015, 0.02);
  const auto grey = [](double v) { return std::round(v * 100) / 100; };
  plan.lighting.ambient = {grey(ambient + warm), grey(ambient), grey(ambient - warm)};
  plan.lighting.background = {0.55, 0.65, 0.80};
  plan.lighting.exposure = grey(dice.between(0.85, 1.15));
  plan.entrance = door.value_or(Eigen::Vector2d(-x, 0));
}

ConveyorFinishes draw_finishes(HallPlan& plan, Dice& dice) {
  const std::string key = plan.name;
  const std::vector<Paint> floors = {{{0.73, 0.74, 0.73}, 0.50}, {{0.62, 0.64, 0.64}, 0.42}, {{0.50, 0.54, 0.52}, 0.36},
                                     {{0.42, 0.44, 0.47}, 0.30}, {{0.72, 0.69, 0.62}, 0.50}, {{0.55, 0.60, 0.55}, 0.40}};
  const Paint floor = dice.pick(floors);
  const Vector3d floor_colour = shaded(floor.colour, dice, 0.05);
  const double wear = dice.unit(), floor_reflectivity = near_to(floor.reflectivity, dice, 0.15);
  plan.finishes["own_floor"] = [=] { return builder::floor_to_order(key + " floor", floor_colour, wear, floor_reflectivity); };
  plan.floor = "own_floor";

  const std::vector<Paint> walls = {{{0.89, 0.89, 0.86}, 0.70},
                                    {{0.86, 0.84, 0.78}, 0.66},
                                    {{0.80, 0.84, 0.87}, 0.64},
                                    {{0.82, 0.86, 0.80}, 0.64},
                                    {{0.70, 0.71, 0.72}, 0.55}};
  const Paint wall = dice.pick(walls);
  const Vector3d wall_colour = shaded(wall.colour, dice, 0.03);
  const double wall_reflectivity = near_to(wall.reflectivity, dice, 0.1);
  plan.finishes["own_wall"] = [=] { return builder::wall_to_order(key + " wall", wall_colour, wall_reflectivity); };
  plan.wall = "own_wall";

  ConveyorFinishes names;
  const std::vector<Paint> rails = {{{0.28, 0.75, 0.21}, 0.60}, {{0.28, 0.75, 0.21}, 0.60}, {{0.14, 0.33, 0.60}, 0.40},
                                    {{0.88, 0.42, 0.12}, 0.60}, {{0.78, 0.79, 0.80}, 0.62}, {{0.92, 0.72, 0.12}, 0.60},
                                    {{0.22, 0.23, 0.24}, 0.18}};
  // Belts are mostly dark, some so dark that a time-of-flight camera hardly sees them.
  const std::vector<Paint> belts = {{{0.16, 0.16, 0.17}, 0.18}, {{0.16, 0.16, 0.17}, 0.12}, {{0.11, 0.11, 0.12}, 0.07},
                                    {{0.13, 0.40, 0.25}, 0.30}, {{0.16, 0.32, 0.55}, 0.30}, {{0.86, 0.86, 0.83}, 0.70}};
  const std::vector<Paint> rollers = {
      {{0.17, 0.17, 0.17}, 0.16}, {{0.12, 0.12, 0.13}, 0.10}, {{0.50, 0.51, 0.53}, 0.42}, {{0.72, 0.72, 0.73}, 0.50}};
  for (int i = 1; i <= 2; ++i) {
    const std::string n = std::to_string(i);
    const Paint rail = dice.pick(rails), belt = dice.pick(belts), roller = dice.pick(rollers);
    const Vector3d rail_colour = shaded(rail.colour, dice, 0.08), belt_colour = shaded(belt.colour, dice, 0.06),
                   roller_colour = shaded(roller.colour, dice, 0.06);
    const double r1 = near_to(rail.reflectivity, dice, 0.15), r2 = near_to(belt.reflectivity, dice, 0.15),
                 r3 = near_to(roller.reflectivity, dice, 0.15);
    const double roughness = std::round(dice.between(0.35, 0.65) * 100) / 100;
    plan.finishes["own_rail_" + n] = [=] { return builder::paint_to_order(key + " rail " + n, rail_colour, roughness, r1); };
    plan.finishes["own_belt_" + n] = [=] { return builder::belt_to_order(key + " belt " + n, belt_colour, r2); };
    plan.finishes["own_roller_" + n] = [=] { return builder::plain_to_order(roller_colour, roughness, r3); };
    names.rails.push_back("own_rail_" + n);
    names.belts.push_back("own_belt_" + n);
    names.rollers.push_back("own_roller_" + n);
  }
  return names;
}

void decorate_walls(HallPlan& plan, Dice& dice) {
  const std::vector<std::string> pictures = {"poster_safety", "poster_project", "poster_lifting", "whiteboard", "clock"};
  for (const PlannedWall& wall : plan.walls) {
    if (dice.chance(0.5)) {
      const double length = to_mm(std::min(wall.length() - 1.0, dice.between(1.0, 1.8)));
      hang(plan, wall, 0, length / 2, make_item([=](Kit& k, int p, const Placement& at) { builder::add_radiator(k, p, at, length); }),
           dice);
    }
    if (dice.chance(0.6)) {
      const double length = to_mm(std::min(wall.length() - 1.0, dice.between(1.5, 5.0)));
      hang(plan, wall, 1.0, length / 2, make_item([=](Kit& k, int p, const Placement& at) { builder::add_cable_duct(k, p, at, length); }),
           dice);
    }
    if (dice.chance(0.4))
      hang(plan, wall, 1.1, 0.3, make_item([](Kit& k, int p, const Placement& at) { builder::add_switch_box(k, p, at); }), dice);
    if (dice.chance(0.4))
      hang(plan, wall, 0.55, 0.15, make_item([](Kit& k, int p, const Placement& at) { builder::add_fire_extinguisher(k, p, at); }), dice);
    for (int i = dice.whole(0, 2); i > 0; --i) {
      const std::string picture = dice.pick(pictures);
      const double width = picture == "whiteboard" ? 1.5 : picture == "clock" ? 0.32 : to_mm(dice.between(0.55, 0.84));
      const double height = picture == "whiteboard" ? 1.0 : picture == "clock" ? 0.32 : to_mm(width * 1.414);
      hang(plan, wall, picture == "clock" ? 2.2 : 1.3, width / 2,
           make_item([=](Kit& k, int p, const Placement& at) { builder::add_wall_picture(k, p, at, width, height, picture); }), dice);
    }
  }
}

void hang_paintings(HallPlan& plan, Dice& dice) {
  for (const PlannedWall& wall : plan.walls) {
    if (!dice.chance(0.5)) continue;
    const bool upright = dice.chance(0.5);
    const double width = to_mm(upright ? dice.between(0.36, 0.54) : dice.between(0.6, 0.9)),
                 height = to_mm(upright ? width * 4 / 3 : width * 3 / 4);
    const std::string picture = upright ? "painting_shapes" : "painting_hills";
    hang(plan, wall, 1.35, width / 2,
         make_item([=](Kit& k, int p, const Placement& at) { builder::add_wall_picture(k, p, at, width, height, picture); }), dice);
  }
}

}  // namespace waretwin::generate
