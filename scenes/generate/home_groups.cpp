#include "scenes/generate/home_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/builder/parts/bags.h"
#include "scenes/builder/parts/beds_and_seats.h"
#include "scenes/builder/parts/books.h"
#include "scenes/builder/parts/fixtures.h"
#include "scenes/builder/parts/furniture.h"
#include "scenes/builder/parts/home_furniture.h"
#include "scenes/builder/parts/home_room.h"

namespace waretwin::generate {

namespace {

using builder::Kit;
using builder::Placement;

constexpr double kGap = 0.03;           // metres between things of different groups
constexpr double kCarpetHeight = 0.02;  // what may lie where the floor stays free
constexpr double kAside = 0.7;          // metres that stay free all round an island

template <class Add>
GroupPiece thing(const Placement& at, Add add) {
  return {make_item([add](Kit& kit, int parent, const Placement& where) { add(kit, parent, where); }), at, {}, {}};
}

template <class Add>
GroupPiece object(const std::string& class_name, const std::string& kind, const Placement& at, Add add) {
  GroupPiece piece = thing(at, add);
  piece.class_name = class_name;
  piece.kind = kind;
  return piece;
}

// Off whole degrees: a mapper that searches headings in such steps must not be flattered by the room.
double off_grid(double degrees) {
  const double off = degrees - std::round(degrees);
  return std::abs(off) > 0.15 ? degrees : std::round(degrees) + (off < 0 ? -0.2 : 0.2);
}

std::string key_of(Dice& dice) { return std::to_string(dice.whole(0, 999)); }

GroupPiece books_on(const Placement& at, Dice& dice) {
  const int count = dice.whole(3, 7);
  const std::string key = key_of(dice);
  return object("books", "pile of books", at, [=](Kit& k, int p, const Placement& w) { builder::add_book_pile(k, p, w, count, key); });
}

GroupPiece wooden_chair(const Placement& at, const builder::WoodenChair& chair) {
  return object("chair", "wooden chair", at, [=](Kit& k, int p, const Placement& w) { builder::add_wooden_chair(k, p, w, chair); });
}

builder::WoodenChair draw_chair(Dice& dice, const HomeFinishes& f) {
  return {.width = to_mm(dice.between(0.41, 0.47)),
          .depth = to_mm(dice.between(0.41, 0.46)),
          .seat = to_mm(dice.between(0.44, 0.47)),
          .height = to_mm(dice.between(0.82, 0.98)),
          .wood = dice.pick(f.woods),
          .cushion = dice.chance(0.5) ? dice.pick(f.fabrics) : std::string()};
}

FurnitureGroup alone(GroupPiece piece, double free_in_front) {
  // Its back on the line.
  piece.at.y = -piece.item.extent.max().y();
  return {{std::move(piece)}, free_in_front};
}

Eigen::AlignedBox2d footprint(const FurnitureGroup& group) {
  Eigen::AlignedBox2d box;
  for (const GroupPiece& piece : group.pieces) {
    const Solid s = solid_of(piece.item.extent, piece.at);
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) box.extend(s.centre + Eigen::Rotation2Dd(s.yaw) * Eigen::Vector2d(x * s.half.x(), y * s.half.y()));
    }
  }
  return box;
}

Solid zone(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Placement& at) {
  return solid_of({Eigen::Vector3d(low.x(), low.y(), kCarpetHeight), Eigen::Vector3d(high.x(), high.y(), 2.0)}, at);
}

bool within(const HallPlan& plan, const Solid& s) {
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const Eigen::Vector2d corner = s.centre + Eigen::Rotation2Dd(s.yaw) * Eigen::Vector2d(x * s.half.x(), y * s.half.y());
      if (std::abs(corner.x()) > plan.length / 2 || std::abs(corner.y()) > plan.width / 2) return false;
    }
  }
  return true;
}

// Stays clear: nothing stands there, and it lies in the room.
bool is_clear(const HallPlan& plan, const Solid& s) {
  return within(plan, s) &&
         std::none_of(plan.solids.begin(), plan.solids.end(), [&](const Solid& other) { return collide(s, other, 0.0); });
}

// What must stay free before, beside or round a group; empty lists where there is no such place.
std::vector<Solid> free_zones(const HallPlan& plan, const FurnitureGroup& group, const Placement& at, bool& found) {
  const Eigen::AlignedBox2d box = footprint(group);
  found = true;
  if (group.island) {
    const Eigen::Vector2d aside(kAside, kAside);
    const Solid round = zone(box.min() - aside, box.max() + aside, at);
    found = is_clear(plan, round);
    return {round};
  }
  std::vector<Solid> zones = {zone({box.min().x(), box.min().y() - group.free_in_front}, {box.max().x(), box.min().y() - 0.01}, at)};
  found = is_clear(plan, zones[0]);
  if (group.free_beside <= 0) return zones;
  const Solid left = zone({box.min().x() - group.free_beside, box.min().y()}, {box.min().x() - 0.01, box.max().y() - 0.3}, at),
              right = zone({box.max().x() + 0.01, box.min().y()}, {box.max().x() + group.free_beside, box.max().y() - 0.3}, at);
  if (is_clear(plan, left)) {
    zones.push_back(left);
  } else if (is_clear(plan, right)) {
    zones.push_back(right);
  } else {
    found = false;
  }
  return zones;
}

}  // namespace

FurnitureGroup draw_bed_group(Dice& dice, const HomeFinishes& f) {
  const std::vector<double> widths = {0.95, 1.05, 1.45, 1.65, 1.85};
  const builder::Bed bed{.length = to_mm(dice.between(2.0, 2.14)),
                         .width = dice.pick(widths),
                         .headboard = to_mm(dice.between(0.75, 1.05)),
                         .frame = dice.pick(f.woods),
                         .linen = "linen_white",
                         .blanket = dice.pick(f.blankets)};
  FurnitureGroup group;
  group.free_in_front = 0.85;
  group.free_beside = 0.75;
  group.pieces.push_back(object("bed", bed.width > 1.25 ? "double bed" : "bed", {0, -bed.length / 2, 0, 0},
                                [=](Kit& k, int p, const Placement& w) { builder::add_bed(k, p, w, bed); }));
  const builder::Chest chest{.width = to_mm(dice.between(0.40, 0.50)),
                             .depth = to_mm(dice.between(0.36, 0.42)),
                             .height = to_mm(dice.between(0.46, 0.58)),
                             .columns = 1,
                             .rows = dice.whole(1, 3),
                             .body = bed.frame,
                             .front = bed.frame};
  bool books = false;
  for (const double side : {-1.0, 1.0}) {
    if (!dice.chance(bed.width > 1.25 ? 0.8 : 0.5)) continue;
    const Placement at{side * (bed.width / 2 + 0.04 + chest.width / 2), -chest.depth / 2 - 0.01, 0, 0};
    group.pieces.push_back(thing(at, [=](Kit& k, int p, const Placement& w) { builder::add_chest(k, p, w, chest); }));
    const Placement top{at.x, at.y, chest.height, off_grid(dice.between(-20, 20))};
    if (!books && dice.chance(0.6)) {
      group.pieces.push_back(books_on(top, dice));
      books = true;
    } else {
      group.pieces.push_back(thing(top, [](Kit& k, int p, const Placement& w) { builder::add_table_lamp(k, p, w); }));
    }
  }
  return group;
}

FurnitureGroup draw_sofa_group(Dice& dice, const HomeFinishes& f) {
  const int seats = dice.whole(2, 3);
  const builder::Sofa sofa{.width = to_mm(0.45 + seats * dice.between(0.50, 0.60)),
                           .depth = to_mm(dice.between(0.84, 0.96)),
                           .height = to_mm(dice.between(0.76, 0.88)),
                           .seats = seats,
                           .cushions = dice.chance(0.7),
                           .fabric = f.fabrics[0],
                           .cushion = f.fabrics[1]};
  FurnitureGroup group;
  group.pieces.push_back(
      object("sofa", "sofa", {0, -sofa.depth / 2, 0, 0}, [=](Kit& k, int p, const Placement& w) { builder::add_sofa(k, p, w, sofa); }));
  if (!dice.chance(0.8)) return group;
  const builder::WoodenTable table{.width = to_mm(dice.between(0.8, 1.15)),
                                   .depth = to_mm(dice.between(0.5, 0.62)),
                                   .height = to_mm(dice.between(0.38, 0.48)),
                                   .wood = dice.pick(f.woods),
                                   .shelf = dice.chance(0.5)};
  const bool carpet = dice.chance(0.6);
  const Placement at{dice.between(-0.15, 0.15), -sofa.depth - 0.42 - table.depth / 2, carpet ? builder::kCarpet : 0.0,
                     off_grid(dice.between(-6, 6))};
  if (carpet) {
    const std::string finish = dice.pick(f.carpets);
    group.pieces.push_back(thing({0, -sofa.depth - 0.08 - 0.6, 0, 0},
                                 [=](Kit& k, int p, const Placement& w) { builder::add_carpet(k, p, w, 1.8, 1.2, finish); }));
  }
  group.pieces.push_back(
      object("table", "low table", at, [=](Kit& k, int p, const Placement& w) { builder::add_wooden_table(k, p, w, table); }));
  const double top = at.z + table.height;
  if (dice.chance(0.6))
    group.pieces.push_back(books_on(placed(at, {dice.between(-0.2, 0.0), 0, table.height, off_grid(dice.between(-40, 40))}), dice));
  if (dice.chance(0.5)) {
    group.pieces.push_back(
        thing({at.x + table.width / 2 - 0.12, at.y, top, 60}, [](Kit& k, int p, const Placement& w) { builder::add_cup(k, p, w); }));
  }
  return group;
}

FurnitureGroup draw_armchair(Dice& dice, const HomeFinishes& f) {
  const builder::Sofa sofa{.width = to_mm(dice.between(0.84, 0.98)),
                           .depth = to_mm(dice.between(0.80, 0.92)),
                           .height = to_mm(dice.between(0.76, 0.92)),
                           .seats = 1,
                           .cushions = dice.chance(0.5),
                           .fabric = dice.pick(f.fabrics),
                           .cushion = f.fabrics[1]};
  return alone(object("sofa", "armchair", {0, 0, 0, off_grid(dice.between(-14, 14))},
                      [=](Kit& k, int p, const Placement& w) { builder::add_sofa(k, p, w, sofa); }),
               0.8);
}

FurnitureGroup draw_television_group(Dice& dice, const HomeFinishes& f) {
  const double set = to_mm(dice.between(0.75, 1.25));
  const builder::Chest board{.width = to_mm(std::max(set + 0.1, dice.between(1.1, 1.8))),
                             .depth = to_mm(dice.between(0.36, 0.46)),
                             .height = to_mm(dice.between(0.42, 0.62)),
                             .columns = dice.whole(2, 3),
                             .rows = 1,
                             .body = dice.pick(f.woods),
                             .front = dice.pick(f.fronts)};
  FurnitureGroup group;
  const Placement at{0, -board.depth / 2, 0, 0};
  group.pieces.push_back(thing(at, [=](Kit& k, int p, const Placement& w) { builder::add_chest(k, p, w, board); }));
  group.pieces.push_back(object("television", "television", {dice.between(-0.03, 0.03), at.y, board.height, off_grid(dice.between(-2, 2))},
                                [=](Kit& k, int p, const Placement& w) { builder::add_television(k, p, w, set); }));
  return group;
}

FurnitureGroup draw_dining_group(Dice& dice, const HomeFinishes& f) {
  const builder::WoodenTable table{.width = to_mm(dice.between(1.15, 1.6)),
                                   .depth = to_mm(dice.between(0.75, 0.92)),
                                   .height = to_mm(dice.between(0.72, 0.77)),
                                   .wood = dice.pick(f.woods)};
  FurnitureGroup group;
  group.island = true;
  group.pieces.push_back(
      object("table", "dining table", {}, [=](Kit& k, int p, const Placement& w) { builder::add_wooden_table(k, p, w, table); }));
  const builder::WoodenChair chair = draw_chair(dice, f);
  // Chairs are pushed in until the seat's edge is just below the top, or stand off by up to 25 cm.
  const auto add_chair = [&](double x, double y, double towards_deg) {
    const Placement seat = placed({x, y, 0, towards_deg}, {0, chair.depth / 2 + dice.between(-0.04, 0.25), 0, 0});
    group.pieces.push_back(wooden_chair({seat.x, seat.y, 0, off_grid(towards_deg + dice.between(-9, 9))}, chair));
  };
  for (const double side : {-1.0, 1.0}) {
    for (const double along : {-1.0, 1.0}) {
      if (dice.chance(side > 0 ? 0.8 : 0.6)) add_chair(along * table.width / 4.0, side * table.depth / 2, side > 0 ? 0 : 180);
    }
  }
  if (group.pieces.size() < 3) add_chair(table.width / 2, 0, -90);
  if (dice.chance(0.5)) {
    group.pieces.push_back(thing({dice.between(-0.15, 0.15), 0, table.height, 0},
                                 [](Kit& k, int p, const Placement& w) { builder::add_fruit_bowl(k, p, w); }));
  } else {
    group.pieces.push_back(
        books_on({dice.between(-0.2, 0.2), dice.between(-0.08, 0.08), table.height, off_grid(dice.between(-40, 40))}, dice));
  }
  return group;
}

FurnitureGroup draw_desk_group(Dice& dice, const HomeFinishes& f) {
  const builder::WoodenTable desk{.width = to_mm(dice.between(1.15, 1.6)),
                                  .depth = to_mm(dice.between(0.6, 0.78)),
                                  .height = to_mm(dice.between(0.72, 0.76)),
                                  .wood = dice.pick(f.woods),
                                  .shelf = false,
                                  .drawers = dice.chance(0.5)};
  FurnitureGroup group;
  group.free_in_front = 0.5;
  group.free_beside = 0.6;
  const double y = -desk.depth / 2, top = desk.height;
  group.pieces.push_back(
      object("table", "desk", {0, y, 0, 0}, [=](Kit& k, int p, const Placement& w) { builder::add_wooden_table(k, p, w, desk); }));
  const double x = dice.between(-0.12, 0.05);
  if (dice.chance(0.5)) {
    group.pieces.push_back(thing({x, y + 0.14, top, dice.between(-8, 8)},
                                 [](Kit& k, int p, const Placement& w) { builder::add_monitor(k, p, w, "screen_code"); }));
    group.pieces.push_back(
        thing({x - 0.04, y - 0.14, top, dice.between(-3, 3)}, [](Kit& k, int p, const Placement& w) { builder::add_keyboard(k, p, w); }));
  } else {
    group.pieces.push_back(
        thing({x, y - 0.05, top, dice.between(-8, 8)}, [](Kit& k, int p, const Placement& w) { builder::add_laptop(k, p, w); }));
  }
  if (dice.chance(0.7)) group.pieces.push_back(books_on({-desk.width / 2 + 0.19, y + 0.06, top, off_grid(dice.between(-12, 12))}, dice));
  const Placement seat{dice.between(-0.2, 0.0), -desk.depth - dice.between(0.36, 0.5), 0, off_grid(180 + dice.between(-28, 28))};
  if (dice.chance(0.65)) {
    const std::string fabric = dice.chance(0.5) ? "fabric_black" : "fabric_blue";
    group.pieces.push_back(
        object("chair", "office chair", seat, [=](Kit& k, int p, const Placement& w) { builder::add_office_chair(k, p, w, fabric); }));
  } else {
    group.pieces.push_back(wooden_chair(seat, draw_chair(dice, f)));
  }
  return group;
}

FurnitureGroup draw_kitchen_group(Dice& dice, const HomeFinishes& f) {
  const double side = dice.chance(0.5) ? 1 : -1;
  const builder::Counter counter{
      .length = 0.6 * dice.whole(3, 4), .depth = 0.62, .sink = true, .hob = dice.chance(0.8), .front = dice.pick(f.fronts)};
  const builder::Refrigerator fridge{.width = to_mm(dice.between(0.55, 0.62)),
                                     .depth = to_mm(dice.between(0.58, 0.66)),
                                     .height = to_mm(dice.between(1.05, 1.45)),
                                     .finish = dice.chance(0.7) ? "enamel" : "light_grey_paint"};
  FurnitureGroup group;
  group.free_in_front = 1.0;
  group.pieces.push_back(
      thing({0, -counter.depth / 2, 0, 0}, [=](Kit& k, int p, const Placement& w) { builder::add_counter(k, p, w, counter); }));
  group.pieces.push_back(
      object("refrigerator", "refrigerator",
             {side * (counter.length + fridge.width + 0.06) / 2, -fridge.depth / 2, 0, off_grid(dice.between(-0.8, 0.8))},
             [=](Kit& k, int p, const Placement& w) { builder::add_refrigerator(k, p, w, fridge); }));
  if (dice.chance(0.6)) {
    const double length = counter.length;
    const std::string front = counter.front;
    group.pieces.push_back(
        thing({0, -0.175, 1.45, 0}, [=](Kit& k, int p, const Placement& w) { builder::add_wall_cupboards(k, p, w, length, front); }));
  }
  if (counter.hob)
    group.pieces.push_back(
        thing({counter.length / 2 - 0.58, -0.2, 0.9068, 30}, [](Kit& k, int p, const Placement& w) { builder::add_pot(k, p, w); }));
  return group;
}

FurnitureGroup draw_bookcase_group(Dice& dice, const HomeFinishes& f) {
  const builder::Bookcase shelf{.width = to_mm(dice.between(0.75, 1.25)),
                                .depth = 0.30,
                                .height = 0.08 + 0.33 * dice.whole(2, 3),
                                .boards = 0,
                                .wood = dice.pick(f.woods)};
  builder::Bookcase whole = shelf;
  whole.boards = 1 + static_cast<int>(std::lround((shelf.height - 0.08) / 0.33));
  FurnitureGroup group;
  const double y = -whole.depth / 2 - 0.005;
  group.pieces.push_back(thing({0, y, 0, 0}, [=](Kit& k, int p, const Placement& w) { builder::add_bookcase(k, p, w, whole); }));
  for (int i = 0; i < whole.boards; ++i) {
    const bool on_top = i + 1 == whole.boards;
    if (!dice.chance(on_top ? 0.6 : 0.85)) continue;
    const double room = whole.width - 0.06, length = to_mm(room * dice.between(0.5, 0.95));
    const double along = dice.between(-0.5, 0.5) * (room - length);
    const std::string key = key_of(dice);
    group.pieces.push_back(object("books", "row of books", {along, y - 0.03, whole.board_top(i), 0},
                                  [=](Kit& k, int p, const Placement& w) { builder::add_book_row(k, p, w, length, 0.28, key); }));
  }
  return group;
}

FurnitureGroup draw_chest_group(Dice& dice, const HomeFinishes& f) {
  const builder::Chest chest{.width = to_mm(dice.between(0.7, 1.1)),
                             .depth = to_mm(dice.between(0.38, 0.46)),
                             .height = to_mm(dice.between(0.7, 0.95)),
                             .columns = dice.whole(1, 2),
                             .rows = 3,
                             .body = dice.pick(f.woods),
                             .front = dice.pick(f.fronts)};
  FurnitureGroup group;
  const double y = -chest.depth / 2;
  group.pieces.push_back(thing({0, y, 0, 0}, [=](Kit& k, int p, const Placement& w) { builder::add_chest(k, p, w, chest); }));
  const Placement top{dice.between(-0.2, 0.2), y, chest.height, off_grid(dice.between(-25, 25))};
  if (dice.chance(0.4)) {
    group.pieces.push_back(books_on(top, dice));
  } else if (dice.chance(0.5)) {
    group.pieces.push_back(thing(top, [](Kit& k, int p, const Placement& w) { builder::add_vase(k, p, w); }));
  } else {
    group.pieces.push_back(thing(top, [](Kit& k, int p, const Placement& w) { builder::add_table_lamp(k, p, w); }));
  }
  return group;
}

FurnitureGroup draw_wardrobe(Dice& dice, const HomeFinishes& f) {
  const builder::Wardrobe wardrobe{.width = to_mm(dice.between(0.95, 2.0)),
                                   .depth = 0.60,
                                   .height = to_mm(dice.between(1.9, 2.15)),
                                   .body = dice.pick(f.woods),
                                   .front = dice.pick(f.fronts)};
  return alone(thing({}, [=](Kit& k, int p, const Placement& w) { builder::add_wardrobe(k, p, w, wardrobe); }), 0.7);
}

FurnitureGroup draw_toilet(Dice& dice) {
  return alone(object("toilet", "toilet", {0, 0, 0, off_grid(dice.between(-0.6, 0.6))},
                      [](Kit& k, int p, const Placement& w) { builder::add_toilet(k, p, w); }),
               0.9);
}

FurnitureGroup draw_washbasin(Dice&) {
  return alone(thing({}, [](Kit& k, int p, const Placement& w) { builder::add_washbasin(k, p, w); }), 0.7);
}

FurnitureGroup draw_bathtub(Dice& dice) {
  const double length = to_mm(dice.between(1.5, 1.75)), width = to_mm(dice.between(0.68, 0.78));
  return alone(thing({}, [=](Kit& k, int p, const Placement& w) { builder::add_bathtub(k, p, w, length, width); }), 0.6);
}

FurnitureGroup draw_bag(Dice& dice) {
  const Placement at{0, 0, 0, off_grid(dice.between(-25, 25))};
  const double kind = dice.unit();
  GroupPiece bag = kind < 0.4 ? object("bag", "backpack", at,
                                       [canvas = std::string(dice.chance(0.5) ? "canvas_red" : "canvas_green")](
                                           Kit& k, int p, const Placement& w) { builder::add_backpack(k, p, w, canvas); })
                   : kind < 0.7
                       ? object("bag", "shopping bag", at, [](Kit& k, int p, const Placement& w) { builder::add_shopping_bag(k, p, w); })
                       : object("bag", "handbag", at,
                                [leather = std::string(dice.chance(0.7) ? "leather_brown" : "leather_black")](
                                    Kit& k, int p, const Placement& w) { builder::add_handbag(k, p, w, leather); });
  FurnitureGroup group = alone(std::move(bag), 0.8);
  group.pieces[0].at.y -= 0.12;  // turned, it reaches farther back
  return group;
}

FurnitureGroup draw_house_plant(Dice& dice) {
  GroupPiece piece = dice.chance(0.5)
                         ? thing({0, 0, 0, dice.between(0, 360)}, [](Kit& k, int p, const Placement& w) { builder::add_plant(k, p, w); })
                         : thing({}, [](Kit& k, int p, const Placement& w) { builder::add_floor_lamp(k, p, w); });
  // Leaves reach out on every side.
  const Eigen::AlignedBox3d& e = piece.item.extent;
  piece.at.y = -std::max({-e.min().x(), -e.min().y(), e.max().x(), e.max().y()}) * 1.3;
  return {{std::move(piece)}, 0.2};
}

bool stand_group(HallPlan& plan, const FurnitureGroup& group, Dice& dice) {
  constexpr int kTries = 60;
  for (int i = 0; i < kTries; ++i) {
    Placement at;
    if (group.island) {
      at = {to_mm(dice.between(-0.5, 0.5) * (plan.length - 2.0)), to_mm(dice.between(-0.5, 0.5) * (plan.width - 2.0)), 0,
            off_grid(90 * dice.whole(0, 3) + dice.between(-4, 4))};
    } else {
      double along = dice.between(0, 2 * (plan.length + plan.width));
      std::size_t k = 0;
      while (k < 3 && along > plan.walls[k].length()) along -= plan.walls[k++].length();
      at = plan.walls[k].at(along, dice.between(0.03, 0.07), 0);
      at.yaw_deg += 180 + (dice.chance(0.5) ? 1 : -1) * dice.between(0.2, 0.7);
    }
    std::vector<Placement> places;
    std::vector<Solid> solids;
    for (const GroupPiece& piece : group.pieces) {
      places.push_back(placed(at, piece.at));
      if (!piece.class_name.empty()) places.back().yaw_deg = off_grid(places.back().yaw_deg);
      solids.push_back(solid_of(piece.item.extent, places.back()));
    }
    if (!std::all_of(solids.begin(), solids.end(), [&](const Solid& s) { return plan.fits(s, kGap); })) continue;
    bool found = false;
    const std::vector<Solid> zones = free_zones(plan, group, at, found);
    if (!found) continue;
    for (std::size_t n = 0; n < places.size(); ++n) {
      const GroupPiece& piece = group.pieces[n];
      const Placement& where = places[n];
      if (piece.class_name.empty()) {
        plan.add(piece.item, where);
        continue;
      }
      const auto same = std::count_if(plan.objects.begin(), plan.objects.end(), [&](const PlannedObject& o) {
        return std::get<FurniturePart>(o.part).class_name == piece.class_name;
      });
      PlannedObject planned;
      planned.name = piece.class_name + "_" + std::to_string(same + 1);
      planned.part = FurniturePart{piece.class_name, piece.kind, [add = piece.item.add](Kit& kit, int parent) { add(kit, parent, {}); },
                                   piece.item.extent};
      planned.at = where;
      plan.objects.push_back(std::move(planned));
      plan.solids.push_back(solid_of(piece.item.extent, where));
    }
    plan.kept_free.insert(plan.kept_free.end(), zones.begin(), zones.end());
    return true;
  }
  return false;
}

}  // namespace waretwin::generate
