#include "scenes/generate/layout.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"
#include "scenes/generate/items.h"

namespace waretwin::generate {

namespace {

using builder::Placement;

// Headings keep this far off whole degrees: a mapper that searches in steps of one must not be flattered by the hall.
constexpr double kOffGridDeg = 0.15;
constexpr double kBetweenStations = 0.45;  // metres
constexpr double kItemGap = 0.03;          // between things on the floor
constexpr double kClutterGap = 0.05;       // between a conveyor and what stands beside it

bool off_grid(const Station& station, double yaw_deg) {
  return std::all_of(station.conveyors.begin(), station.conveyors.end(), [&](const PlannedObject& c) {
    const double yaw = c.at.yaw_deg + yaw_deg;
    return std::abs(yaw - std::round(yaw)) > kOffGridDeg;
  });
}

Solid zone(const Eigen::AlignedBox2d& box, const Placement& at, double high) {
  Eigen::AlignedBox3d extent(Eigen::Vector3d(box.min().x(), box.min().y(), 0), Eigen::Vector3d(box.max().x(), box.max().y(), high));
  return solid_of(extent, at);
}

// Where the vehicle stands to look at a station; nothing may be put there.
Solid approach(const Station& s, const Placement& at) {
  const double beside = std::max(s.free_beside, 1.25 - 0.5 * s.footprint.sizes().x());
  return zone({Eigen::Vector2d(s.footprint.min().x() - beside, s.footprint.min().y() - s.free_in_front),
               Eigen::Vector2d(s.footprint.max().x() + beside, s.footprint.min().y() - 0.02)},
              at, 3.0);
}

// Where it stands beside a station that must be seen from its sides.
std::vector<Solid> side_lanes(const Station& s, const Placement& at) {
  if (!s.sides_matter) return {};
  constexpr double kLane = 1.4;
  const Eigen::AlignedBox2d& f = s.footprint;
  const double back = f.max().y() - 0.35;
  return {zone({Eigen::Vector2d(f.max().x() + 0.02, f.min().y()), Eigen::Vector2d(f.max().x() + kLane, back)}, at, 3.0),
          zone({Eigen::Vector2d(f.min().x() - kLane, f.min().y()), Eigen::Vector2d(f.min().x() - 0.02, back)}, at, 3.0)};
}

Solid body(const Station& s, const Placement& at) { return zone(s.footprint, at, 1.2); }

// Inside the room as a whole, and deep enough for a vehicle to turn in front.
bool within(const HallPlan& plan, const Solid& solid) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector2d corner =
          solid.centre + Eigen::Rotation2Dd(solid.yaw) * Eigen::Vector2d(sx * solid.half.x(), sy * solid.half.y());
      if (std::abs(corner.x()) > plan.length / 2 + 0.01 || std::abs(corner.y()) > plan.width / 2 + 0.01) return false;
    }
  }
  return true;
}

// How far a conveyor reaches to the station's back.
double turned_top(const PlannedObject& c) {
  double top = -1e9;
  for (const Solid& s : c.solids()) {
    top = std::max(top, s.centre.y() + s.half.x() * std::abs(std::sin(s.yaw)) + s.half.y() * std::abs(std::cos(s.yaw)));
  }
  return top;
}

bool station_fits(const HallPlan& plan, const std::vector<Standing>& others, const Station& s, const Placement& at, bool island) {
  const Solid here = body(s, at);
  if (!plan.fits(here, kBetweenStations)) return false;
  // Straight ahead there is room to turn, whatever stands or is still to be put to the sides.
  const Solid lane = zone({Eigen::Vector2d(s.footprint.center().x() - 0.75, s.footprint.min().y() - 1.45),
                           Eigen::Vector2d(s.footprint.center().x() + 0.75, s.footprint.min().y() - 0.05)},
                          at, 3.0);
  if (!within(plan, lane)) return false;
  const Solid front = approach(s, at);
  for (const Solid& other : plan.solids) {
    if (collide(front, other, 0.0)) return false;
  }
  for (const Solid& side : side_lanes(s, at)) {
    if (!within(plan, side)) return false;
    if (std::any_of(plan.solids.begin(), plan.solids.end(), [&](const Solid& other) { return collide(side, other, 0.0); })) return false;
  }
  if (!island) return true;
  // All round an island vehicles drive.
  Solid round = here;
  round.half += Eigen::Vector2d::Constant(1.4);
  if (!within(plan, round)) return false;
  return std::none_of(others.begin(), others.end(), [&](const Standing& o) { return collide(round, body(o.station, o.at), 0.0); });
}

}  // namespace

bool stand_somewhere(HallPlan& plan, std::vector<Standing>& standing, Station station, Where where, Dice& dice) {
  const bool island = where != Where::kWall;
  constexpr int kTries = 60;
  for (int i = 0; i < kTries; ++i) {
    Placement at;
    if (island) {
      at = {dice.between(-0.5, 0.5) * std::max(0.0, plan.length - 4.5), dice.between(-0.5, 0.5) * std::max(0.0, plan.width - 4.5), 0,
            where == Where::kLine ? 90 * dice.whole(0, 3) + dice.between(-2, 2) : dice.between(0, 360)};
    } else {
      double along = dice.between(0, 2 * (plan.length + plan.width));
      std::size_t k = 0;
      while (k < 3 && along > plan.walls[k].length()) along -= plan.walls[k++].length();
      const double back = station.footprint.max().y();
      // Behind a conveyor is too little room for a vehicle to see its back, or enough to drive there.
      double behind = 0.0;
      for (const PlannedObject& c : station.conveyors) behind = std::max(behind, back - turned_top(c));
      at = plan.walls[k].at(along, dice.between(0.10, std::max(0.16, 0.62 - behind)) + back, 0);
      at.yaw_deg += 180 + dice.between(-3.5, 3.5);
    }
    at.x = to_mm(at.x);
    at.y = to_mm(at.y);
    if (!off_grid(station, at.yaw_deg) || !station_fits(plan, standing, station, at, island)) continue;
    place_station(plan, station, at);
    plan.kept_free.push_back(approach(station, at));
    for (const Solid& side : side_lanes(station, at)) plan.kept_free.push_back(side);
    if (island) {
      Solid round = body(station, at);
      round.half += Eigen::Vector2d::Constant(1.35);
      plan.kept_free.push_back(round);
    }
    standing.push_back({std::move(station), at});
    return true;
  }
  return false;
}

void add_neighbours(HallPlan& plan, const Standing& s, double clutter, Dice& dice) {
  const Eigen::AlignedBox2d& f = s.station.footprint;
  for (const double side : {-1.0, 1.0}) {
    if (!dice.chance(clutter)) continue;
    const double edge = side < 0 ? f.min().x() : f.max().x();
    const double kind = dice.unit();
    if (kind < 0.5) {
      const double width = to_mm(dice.between(0.6, 1.1)), depth = to_mm(std::min(f.sizes().y(), dice.between(0.5, 0.75)));
      const double height = to_mm(dice.between(0.70, 0.80));
      const Item item = table(width, depth, height, dice.chance(0.5) ? "table_top" : "beech", dice.chance(0.3));
      const Placement local{edge + side * (width / 2 + dice.between(0.05, 0.25)), f.max().y() - depth / 2 - dice.between(0, 0.1), 0,
                            dice.between(-2, 2)};
      const Placement at = placed(s.at, local);
      if (plan.try_add(item, at, kItemGap)) {
        Placement top = at;
        top.z = height;
        furnish(plan, {top, width, depth}, dice.whole(1, 3), 0.02, dice);
      }
    } else if (kind < 0.72 && !s.station.supports.empty()) {
      const Item item = draw_leaning_panel(dice);
      // Its upper edge just touches the side.
      const Placement local{edge + side * (item.extent.max().y() + 0.012), dice.between(-0.08, 0.12), 0, side * 90};
      plan.try_add(item, placed(s.at, local), 0.004);
    } else {
      const Item item = dice.chance(0.7) ? bin_stack(dice) : draw_floor_item(dice);
      const Placement local{edge + side * dice.between(0.3, 0.7), dice.between(f.center().y(), f.max().y()), 0, dice.between(-15, 15)};
      plan.try_add(item, placed(s.at, local), kItemGap);
    }
  }
  for (const Top& top : s.station.tops) {
    furnish(plan, {placed(s.at, top.at), top.width, top.depth}, static_cast<int>(std::lround(clutter * dice.between(1.5, 5.5))),
            kClutterGap, dice);
  }
}

bool stand_at_wall(HallPlan& plan, const Item& item, double gap, Placement& at, Dice& dice) {
  constexpr int kTries = 10;
  for (int i = 0; i < kTries; ++i) {
    double along = dice.between(0, 2 * (plan.length + plan.width));
    std::size_t k = 0;
    while (k < 3 && along > plan.walls[k].length()) along -= plan.walls[k++].length();
    at = plan.walls[k].at(along, item.extent.max().y() + gap, 0);
    at.yaw_deg += 180 + dice.between(-1.0, 1.0) * std::min(2.0, 20 * gap);
    if (plan.try_add(item, at, kItemGap)) return true;
  }
  return false;
}

void add_wall_items(HallPlan& plan, int count, Dice& dice) {
  for (int i = 0; i < count; ++i) {
    const WallItem drawn = draw_wall_item(dice, plan.height);
    Placement at;
    if (!stand_at_wall(plan, drawn.item, drawn.top > 0 ? dice.between(0.04, 0.12) : 0.012, at, dice)) continue;
    if (drawn.top > 0) {
      Placement top = at;
      top.z = drawn.top;
      furnish(plan, {top, drawn.top_width, drawn.top_depth}, dice.whole(1, 4), 0.02, dice);
    }
    if (drawn.seat && dice.chance(0.6)) {
      const Placement seat =
          placed(at, {dice.between(-0.25, 0.25), drawn.item.extent.min().y() - dice.between(0.35, 0.6), 0, 180 + dice.between(-50, 50)});
      plan.try_add(chair(dice), seat, 0.01);
    }
  }
}

void add_floor_items(HallPlan& plan, int count, Dice& dice) {
  constexpr int kTries = 25;
  for (int i = 0; i < count; ++i) {
    const Item item = draw_floor_item(dice);
    const bool straight = dice.chance(0.6);
    for (int attempt = 0; attempt < kTries; ++attempt) {
      // Near the walls rather than in the way.
      double along = dice.between(0, 2 * (plan.length + plan.width));
      std::size_t k = 0;
      while (k < 3 && along > plan.walls[k].length()) along -= plan.walls[k++].length();
      const double reach = std::max(item.extent.sizes().x(), item.extent.sizes().y()) / 2;
      Placement at = plan.walls[k].at(along, reach + dice.between(0.05, 0.8), 0);
      at.yaw_deg += straight ? dice.between(-6, 6) : dice.between(0, 360);
      if (plan.try_add(item, at, kItemGap)) break;
    }
  }
}

void add_floor_marks(HallPlan& plan, const std::vector<Standing>& standing, Dice& dice) {
  const std::vector<std::string> tapes = {"hazard_tape", "yellow_tape"};
  const bool docks = dice.chance(0.6);
  const std::string finish = dice.pick(tapes);
  for (const Standing& s : standing) {
    if (!docks) continue;
    const double y = s.station.footprint.min().y() - 0.06;
    FloorMark mark{{}, 0.06, finish};
    for (const double x : {s.station.footprint.min().x(), s.station.footprint.max().x()}) {
      const Placement p = placed(s.at, {x, y, 0, 0});
      mark.path.emplace_back(p.x, p.y);
    }
    plan.marks.push_back(mark);
  }
  if (dice.chance(0.6)) {
    const double inset = dice.between(1.6, 2.0), x = plan.length / 2 - inset, y = plan.width / 2 - inset;
    if (x > 0.6 && y > 0.4)
      plan.marks.push_back({{{-x, -y}, {x, -y}, {x, y}, {-x, y}, {-x, -y}}, to_mm(dice.between(0.05, 0.1)), "yellow_tape"});
  }
}

}  // namespace waretwin::generate
