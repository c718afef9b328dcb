#include "scenes/generate/warehouse.h"

#include <algorithm>
#include <cmath>

#include "scenes/builder/parts/storage.h"
#include "scenes/generate/items.h"
#include "scenes/generate/layout.h"
#include "scenes/generate/room_plan.h"

namespace waretwin::generate {

namespace {

using builder::Kit;
using builder::Placement;

constexpr double kAisle = 1.5;  // metres before a rack that stay free

Item rack(Dice& dice, int bays, double room_height) {
  builder::Rack r;
  r.bays = bays;
  r.level_height = to_mm(dice.between(1.35, 1.7));
  r.levels = std::clamp(static_cast<int>((room_height - 1.8) / r.level_height), 1, 3);
  r.fill = dice.between(0.55, 0.95);
  r.key = "generated" + std::to_string(dice.whole(0, 9999));
  return make_item([=](Kit& kit, int parent, const Placement& at) { add_rack(kit, parent, at, r); });
}

// Racks along one or two walls, in pieces of a few bays.
void add_racks(HallPlan& plan, Dice& dice) {
  constexpr double kBay = 2.7;
  const std::size_t first = static_cast<std::size_t>(dice.whole(0, 3));
  const int walls = dice.chance(0.5) ? 2 : 1;
  for (int w = 0; w < walls; ++w) {
    const PlannedWall& wall = plan.walls[(first + static_cast<std::size_t>(w)) % 4];
    double along = dice.between(0.6, 2.0);
    while (along + kBay + 0.5 < wall.length()) {
      const int most = static_cast<int>((wall.length() - along - 0.5) / kBay);
      const int bays = std::min(most, dice.whole(1, 4));
      const Item item = rack(dice, bays, plan.height);
      const double length = item.extent.sizes().x();
      Placement at = wall.at(to_mm(along + length / 2), to_mm(item.extent.max().y() + 0.12), 0);
      at.yaw_deg += 180;
      if (plan.try_add(item, at, 0.05)) {
        const Eigen::Vector3d low(item.extent.min().x(), item.extent.min().y() - kAisle, 0),
            high(item.extent.max().x(), item.extent.min().y() - 0.02, 3);
        plan.kept_free.push_back(solid_of({low, high}, at));
      }
      along += length + (dice.chance(0.7) ? 0.1 : dice.between(1.0, 3.0));
    }
  }
}

// Loaded pallets in rows with space between, as goods that wait.
void add_staging(HallPlan& plan, int places, Dice& dice) {
  constexpr int kTries = 30;
  for (int done = 0, i = 0; done < places && i < kTries; ++i) {
    const Placement corner{dice.between(-0.45, 0.45) * plan.length, dice.between(-0.45, 0.45) * plan.width, 0, 90.0 * dice.whole(0, 3)};
    const int columns = dice.whole(2, 4), rows = dice.whole(1, 2);
    for (int c = 0; c < columns; ++c) {
      for (int r = 0; r < rows; ++r) {
        if (dice.chance(0.2)) continue;
        const Item item = loaded_pallet(dice);
        if (plan.try_add(item, placed(corner, {1.35 * c, 1.0 * r, 0, dice.between(-3, 3)}), 0.06)) ++done;
      }
    }
  }
}

template <class Add>
Item simple(Add add) {
  return make_item([add](Kit& kit, int parent, const Placement& at) { add(kit, parent, at); });
}

void add_guards(HallPlan& plan, int count, Dice& dice) {
  for (int i = 0; i < count; ++i) {
    const double length = to_mm(dice.between(1.5, 3.5)), kind = dice.unit(), height = plan.height;
    const Item item = kind < 0.35   ? simple([=](Kit& k, int p, const Placement& at) { builder::add_barrier(k, p, at, length); })
                      : kind < 0.6  ? simple([](Kit& k, int p, const Placement& at) { builder::add_post(k, p, at); })
                      : kind < 0.75 ? simple([=](Kit& k, int p, const Placement& at) { builder::add_fence(k, p, at, length); })
                                    : simple([=](Kit& k, int p, const Placement& at) { builder::add_column(k, p, at, height); });
    constexpr int kTries = 10;
    for (int k = 0; k < kTries; ++k) {
      const Placement at{to_mm(dice.between(-0.48, 0.48) * plan.length), to_mm(dice.between(-0.48, 0.48) * plan.width), 0,
                         90.0 * dice.whole(0, 1)};
      if (plan.try_add(item, at, 0.1)) break;
    }
  }
}

}  // namespace

std::optional<HallPlan> draw_warehouse(const GenerateConfig& config, int attempt) {
  Dice room(config.seed, "warehouse room", attempt), lines(config.seed, "lines", attempt), things(config.seed, "stores", attempt);
  HallPlan plan;
  plan.name = "warehouse_" + std::to_string(config.seed);
  plan.title = "A warehouse";
  plan.description = "A random warehouse";
  const int count = config.conveyors > 0 ? config.conveyors : room.whole(6, 10);
  const double clutter = config.clutter >= 0 ? config.clutter : room.between(0.4, 1.0);
  const double area = count * room.between(17.0, 24.0) + 90.0, aspect = room.between(1.2, 1.8);
  const auto size = [](double asked, double drawn) { return asked > 0 ? asked : std::round(drawn * 2) / 2; };
  const double height = std::round(room.between(4.5, 7.5) * 10) / 10;
  const ConveyorFinishes finishes = draw_finishes(plan, room);
  draw_room(plan, size(config.length_m, std::sqrt(area * aspect)), size(config.width_m, std::sqrt(area / aspect)), height, room);
  if (std::min(plan.length, plan.width) > 8.0) add_racks(plan, things);

  // Lines in the middle first: they need most room. What is left goes to packing places at the walls.
  std::vector<Standing> standing;
  int left = count;
  while (left > 0) {
    const bool line = left > 1 && lines.chance(0.75);
    const int segments = line ? std::min(left, lines.whole(2, 4)) : 1;
    bool done = false;
    constexpr int kDraws = 5;
    for (int k = 0; k < kDraws && !done; ++k) {
      if (line) {
        done = stand_somewhere(plan, standing, draw_line(lines, finishes, segments), Where::kLine, lines);
      } else if (lines.chance(0.5)) {
        done = stand_somewhere(plan, standing, draw_table_top_station(lines, finishes, 1, 0.0), Where::kWall, lines);
      } else {
        done = stand_somewhere(plan, standing, draw_floor_station(lines, finishes, 1, 0.0), Where::kWall, lines);
      }
    }
    if (!done) return std::nullopt;
    left -= segments;
  }
  for (const Standing& s : standing) {
    if (!s.station.tops.empty()) add_neighbours(plan, s, clutter, things);
  }
  const double floor = plan.length * plan.width;
  add_staging(plan, static_cast<int>(std::lround(clutter * floor * 0.03)), things);
  add_guards(plan, static_cast<int>(std::lround(clutter * floor * 0.015)), things);
  add_wall_items(plan, static_cast<int>(std::lround(clutter * (plan.length + plan.width) * 0.2)), things);
  add_floor_items(plan, static_cast<int>(std::lround(clutter * (plan.length + plan.width) * 0.25)), things);
  decorate_walls(plan, things);
  add_floor_marks(plan, standing, things);
  return plan;
}

}  // namespace waretwin::generate
