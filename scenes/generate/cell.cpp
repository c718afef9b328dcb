#include "scenes/generate/cell.h"

#include <algorithm>
#include <cmath>

#include "scenes/generate/layout.h"
#include "scenes/generate/room_plan.h"

namespace waretwin::generate {

std::optional<HallPlan> draw_cell(const GenerateConfig& config, int attempt) {
  Dice room(config.seed, "room", attempt), stations(config.seed, "stations", attempt), things(config.seed, "things", attempt);
  HallPlan plan;
  plan.name = "cell_" + std::to_string(config.seed);
  plan.title = "A production cell";
  plan.description = "A random production cell";
  const int count = config.conveyors > 0 ? config.conveyors : room.whole(3, 6);
  const double clutter = config.clutter >= 0 ? config.clutter : room.between(0.45, 1.0);
  const double area = count * room.between(8.0, 10.5) + 24.0, aspect = room.between(1.2, 2.0);
  const double drawn_length = std::sqrt(area * aspect);
  const double length = config.length_m > 0 ? config.length_m : std::round(drawn_length * 10) / 10;
  const double width = config.width_m > 0 ? config.width_m : std::round(std::max(5.2, area / drawn_length) * 10) / 10;
  const double height = std::round(room.between(2.9, 4.2) * 10) / 10;
  const ConveyorFinishes finishes = draw_finishes(plan, room);
  draw_room(plan, length, width, height, room);

  std::vector<int> groups(static_cast<std::size_t>(count), 1);
  if (count > 1 && stations.chance(config.close_share)) {
    groups.pop_back();
    groups[0] = 2;
  }
  std::vector<Standing> standing;
  const bool islands = std::min(length, width) > 6.2 && stations.chance(0.5);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double apart = to_mm(stations.between(0.05, 0.30));
    const bool on_table = stations.chance(0.65), island = islands && i + 1 == groups.size();
    constexpr int kDraws = 4;
    bool done = false;
    for (int k = 0; k < kDraws && !done; ++k) {
      Station station = on_table ? draw_table_top_station(stations, finishes, groups[i], apart)
                                 : draw_floor_station(stations, finishes, groups[i], apart);
      done = stand_somewhere(plan, standing, std::move(station), island && k < 2 ? Where::kIsland : Where::kWall, stations);
    }
    if (!done) return std::nullopt;
  }
  for (const Standing& s : standing) add_neighbours(plan, s, clutter, things);
  const double perimeter = 2 * (length + width);
  add_wall_items(plan, static_cast<int>(std::lround(clutter * perimeter * things.between(0.12, 0.3))), things);
  add_floor_items(plan, static_cast<int>(std::lround(clutter * perimeter * things.between(0.1, 0.3))), things);
  decorate_walls(plan, things);
  add_floor_marks(plan, standing, things);
  return plan;
}

}  // namespace waretwin::generate
