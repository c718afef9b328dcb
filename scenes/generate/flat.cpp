#include "scenes/generate/flat.h"

#include <cmath>

#include "scenes/builder/finishes.h"
#include "scenes/builder/parts/storage.h"
#include "scenes/generate/layout.h"
#include "scenes/generate/room_plan.h"

namespace waretwin::generate {

std::optional<HallPlan> draw_flat(const GenerateConfig& config, int attempt) {
  Dice room(config.seed, "flat room", attempt), things(config.seed, "flat things", attempt);
  HallPlan plan;
  plan.name = "flat_" + std::to_string(config.seed);
  plan.title = "A bare room";
  plan.description = "A bare room for quick tests";
  const int count = config.conveyors > 0 ? config.conveyors : room.whole(2, 3);
  const double area = 8.0 * count + 16.0, aspect = room.between(1.1, 1.6);
  const auto size = [](double asked, double drawn) { return asked > 0 ? asked : std::round(drawn * 10) / 10; };
  const ConveyorFinishes finishes = draw_finishes(plan, room);
  // Without textures.
  plan.finishes["own_floor"] = [] { return builder::plain_to_order({0.70, 0.71, 0.71}, 0.8, 0.5); };
  plan.finishes["own_wall"] = [] { return builder::plain_to_order({0.86, 0.86, 0.84}, 0.9, 0.7); };
  draw_room(plan, size(config.length_m, std::sqrt(area * aspect)), size(config.width_m, std::max(5.0, std::sqrt(area / aspect))), 3.0,
            room);
  for (PlannedWall& wall : plan.walls) wall.openings.clear();
  plan.kept_free.clear();

  std::vector<Standing> standing;
  for (int i = 0; i < count; ++i) {
    constexpr int kDraws = 4;
    bool done = false;
    for (int k = 0; k < kDraws && !done; ++k) {
      done = stand_somewhere(plan, standing, draw_table_top_station(things, finishes, 1, 0.0), Where::kWall, things);
    }
    if (!done) return std::nullopt;
  }
  const double clutter = config.clutter >= 0 ? config.clutter : 0.5;
  for (int i = static_cast<int>(std::lround(8 * clutter)); i > 0; --i) {
    const double dx = to_mm(things.between(0.25, 0.6)), dy = to_mm(things.between(0.25, 0.5)), dz = to_mm(things.between(0.2, 0.6));
    const Item carton =
        make_item([=](builder::Kit& kit, int parent, const builder::Placement& at) { builder::add_carton(kit, parent, at, dx, dy, dz); });
    builder::Placement at;
    stand_at_wall(plan, carton, things.between(0.02, 0.6), at, things);
  }
  return plan;
}

}  // namespace waretwin::generate
