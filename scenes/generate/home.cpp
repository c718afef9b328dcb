#include "scenes/generate/home.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/builder/finishes.h"
#include "scenes/builder/home_finishes.h"
#include "scenes/builder/parts/home_room.h"
#include "scenes/generate/home_groups.h"
#include "scenes/generate/room_plan.h"

namespace waretwin::generate {

namespace {

using builder::Kit;
using builder::Placement;
using Eigen::Vector3d;

using DrawGroup = std::function<FurnitureGroup(Dice&, const HomeFinishes&)>;

template <class Draw>
DrawGroup plainly(Draw draw) {  // groups that take no finishes
  return [draw](Dice& dice, const HomeFinishes&) { return draw(dice); };
}

// What a kind of room is: how large, what must stand in it, what may.
struct RoomKind {
  const char* title;
  double share;              // of all rooms
  double least_m2, most_m2;  // of floor
  bool tiled;
  std::vector<DrawGroup> needs;  // in the order in which places are looked for
  std::vector<DrawGroup> may;
};

const std::vector<RoomKind>& room_kinds() {
  static const std::vector<RoomKind> kinds = {
      {"A living room",
       0.26,
       18,
       28,
       false,
       {draw_sofa_group, draw_television_group},
       {draw_armchair, draw_bookcase_group, plainly(draw_bag), plainly(draw_house_plant), draw_chest_group}},
      {"A bedroom",
       0.22,
       14,
       21,
       false,
       {draw_bed_group, draw_wardrobe},
       {draw_desk_group, plainly(draw_bag), draw_chest_group, draw_television_group, draw_armchair}},
      {"A study",
       0.18,
       11,
       18,
       false,
       {draw_desk_group, draw_bookcase_group},
       {draw_armchair, plainly(draw_bag), draw_bookcase_group, plainly(draw_house_plant)}},
      {"A kitchen",
       0.18,
       15,
       23,
       false,
       {draw_kitchen_group, draw_dining_group},
       {plainly(draw_bag), draw_chest_group, plainly(draw_house_plant)}},
      {"A bathroom", 0.06, 8, 12, true, {plainly(draw_bathtub), plainly(draw_toilet), plainly(draw_washbasin)}, {plainly(draw_bag)}},
      {"A flat of one room",
       0.10,
       28,
       38,
       false,
       {draw_bed_group, draw_sofa_group, draw_kitchen_group},
       {draw_television_group, draw_desk_group, draw_wardrobe, plainly(draw_bag), draw_bookcase_group, plainly(draw_house_plant)}},
  };
  return kinds;
}

const RoomKind& draw_kind(Dice& dice) {
  double left = dice.unit();
  for (const RoomKind& kind : room_kinds()) {
    left -= kind.share;
    if (left < 0) return kind;
  }
  return room_kinds().back();
}

Vector3d shaded(const Vector3d& colour, Dice& dice) {
  const double light = dice.between(0.9, 1.1);
  Vector3d c;
  for (int k = 0; k < 3; ++k) c[k] = std::clamp(colour[k] * light, 0.04, 0.96);
  return c;
}

double rounded(double value) { return std::round(value * 100) / 100; }

HomeFinishes draw_home_finishes(HallPlan& plan, bool tiled, Dice& dice) {
  const std::string key = plan.name;
  const std::vector<Vector3d> planks = {{0.76, 0.62, 0.43}, {0.55, 0.38, 0.24}, {0.82, 0.74, 0.60}, {0.46, 0.42, 0.38}},
                              stones = {{0.60, 0.60, 0.58}, {0.78, 0.74, 0.66}, {0.42, 0.42, 0.44}},
                              walls = {{0.91, 0.89, 0.83}, {0.76, 0.80, 0.73}, {0.72, 0.79, 0.85}, {0.88, 0.80, 0.72}, {0.92, 0.92, 0.91}};
  const Vector3d floor = shaded(dice.pick(tiled ? stones : planks), dice), wall = shaded(dice.pick(walls), dice);
  const double floor_back = rounded(dice.between(0.42, 0.6)), wall_back = rounded(dice.between(0.6, 0.72));
  plan.finishes["own_floor"] = [=] {
    return tiled ? builder::tiles_to_order(key + " floor", floor, 0.3, floor_back)
                 : builder::parquet_to_order(key + " floor", floor, floor_back);
  };
  plan.finishes["own_wall"] = [=] {
    return tiled ? builder::tiles_to_order(key + " wall", wall, 0.2, wall_back) : builder::wall_to_order(key + " wall", wall, wall_back);
  };
  plan.floor = "own_floor";
  plan.wall = "own_wall";
  // Skirtings and doors of wood, not of metal.
  plan.finishes["skirting"] = [] { return builder::make_finish("white_lacquer"); };
  plan.finishes["door_paint"] = [] { return builder::make_finish("pine"); };

  HomeFinishes names;
  const std::vector<Vector3d> woods = {{0.74, 0.59, 0.41}, {0.45, 0.33, 0.22}, {0.86, 0.73, 0.53}, {0.30, 0.22, 0.17}, {0.88, 0.87, 0.85}};
  const std::vector<Vector3d> fabrics = {{0.48, 0.49, 0.50}, {0.29, 0.44, 0.33}, {0.76, 0.70, 0.59}, {0.80, 0.59, 0.16},
                                         {0.66, 0.32, 0.20}, {0.20, 0.27, 0.44}, {0.24, 0.23, 0.23}, {0.55, 0.36, 0.44}};
  for (int i = 1; i <= 2; ++i) {
    const std::string name = "own_wood_" + std::to_string(i);
    const Vector3d colour = shaded(dice.pick(woods), dice);
    const double back = rounded(dice.between(0.4, 0.7));
    plan.finishes[name] = [=] { return builder::wood_to_order(key + " " + name, colour, back); };
    names.woods.push_back(name);
  }
  for (int i = 1; i <= 3; ++i) {
    const std::string name = "own_fabric_" + std::to_string(i);
    const Vector3d colour = shaded(dice.pick(fabrics), dice);
    const double back = rounded(dice.between(0.15, 0.6));
    plan.finishes[name] = [=] { return builder::fabric_to_order(key + " " + name, colour, back); };
    names.fabrics.push_back(name);
  }
  const Vector3d ground = shaded(dice.pick(fabrics), dice), border = shaded(dice.pick(fabrics), dice);
  plan.finishes["own_carpet"] = [=] { return builder::carpet_to_order(key + " carpet", ground, border, 0.45); };
  names.carpets = {"own_carpet"};
  names.blankets = {"blanket_blue", names.fabrics[1], names.fabrics[2]};
  names.fronts = {"white_lacquer", "kitchen_front", names.woods[0]};
  return names;
}

void add_lamps(HallPlan& plan, Dice& dice) {
  plan.lamps.clear();
  const int count = plan.length * plan.width > 22 ? 2 : 1;
  const double intensity = rounded(dice.between(8.0, 13.0));
  const Item lamp = make_item([=](Kit& kit, int parent, const Placement& at) { builder::add_round_lamp(kit, parent, at, intensity); });
  for (int i = 0; i < count; ++i) {
    const double along = ((i + 0.5) / count - 0.5) * plan.length;
    plan.items.push_back({lamp, {to_mm(along), 0, plan.height, 0}});
  }
}

// Nothing high stands before a window, and vehicles keep off its sill.
void keep_windows_free(HallPlan& plan) {
  constexpr double kDeep = 0.5, kSillDeep = 0.08, kSillHigh = 0.03, kSillBeyond = 0.05;  // of the sill as parts/room.cpp builds it
  for (const PlannedWall& wall : plan.walls) {
    for (const PlannedOpening& o : wall.openings) {
      if (o.kind != PlannedOpening::Kind::kWindow) continue;
      const double along = o.hole.along + o.hole.width / 2, half = o.hole.width / 2;
      plan.kept_free.push_back(solid_of({Vector3d(-half, 0, 0), Vector3d(half, kDeep, o.hole.height)}, wall.at(along, 0, o.hole.above)));
      plan.solids.push_back(solid_of({Vector3d(-half - kSillBeyond, 0, -kSillHigh), Vector3d(half + kSillBeyond, kSillDeep, 0)},
                                     wall.at(along, 0, o.hole.above)));
    }
  }
}

}  // namespace

const std::vector<std::string>& home_classes() {
  static const std::vector<std::string> classes = {"bed", "chair", "sofa", "table", "books", "refrigerator", "television", "toilet", "bag"};
  return classes;
}

std::optional<HallPlan> draw_home(const GenerateConfig& config, int attempt) {
  // What kind of room a seed gives does not hang on how many draws it takes.
  Dice kinds(config.seed, "home kind"), room(config.seed, "home room", attempt), things(config.seed, "home things", attempt);
  const RoomKind& kind = draw_kind(kinds);
  HallPlan plan;
  plan.name = "home_" + std::to_string(config.seed);
  plan.title = kind.title;
  plan.description = std::string(kind.title) + ", furnished at random";
  plan.what = "objects";
  const double area = room.between(kind.least_m2, kind.most_m2), aspect = room.between(1.05, 1.5);
  const auto size = [](double asked, double drawn) { return asked > 0 ? asked : std::round(drawn * 10) / 10; };
  const HomeFinishes finishes = draw_home_finishes(plan, kind.tiled, room);
  draw_room(plan, size(config.length_m, std::sqrt(area * aspect)), size(config.width_m, std::sqrt(area / aspect)),
            rounded(room.between(2.4, 2.75)), room);
  add_lamps(plan, room);
  keep_windows_free(plan);

  for (const DrawGroup& draw : kind.needs) {
    constexpr int kDraws = 4;
    bool done = false;
    for (int k = 0; k < kDraws && !done; ++k) done = stand_group(plan, draw(things, finishes), things);
    if (!done) return std::nullopt;
  }
  const double clutter = config.clutter >= 0 ? config.clutter : things.between(0.55, 1.0);
  for (const DrawGroup& draw : kind.may) {
    if (things.chance(clutter)) stand_group(plan, draw(things, finishes), things);
  }
  hang_paintings(plan, things);
  return plan;
}

}  // namespace waretwin::generate
