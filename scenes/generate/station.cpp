#include "scenes/generate/station.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"

namespace waretwin::generate {

namespace {

using builder::Placement;

// The box of a part turned by a yaw, on the floor plan about the part's origin.
Eigen::AlignedBox2d turned_extent(const ObjectPart& part, double yaw_deg) {
  const Eigen::AlignedBox3d e = extent_of(part);
  Eigen::AlignedBox2d box;
  const Eigen::Rotation2Dd R(to_radians(yaw_deg));
  for (const double x : {e.min().x(), e.max().x()}) {
    for (const double y : {e.min().y(), e.max().y()}) box.extend(R * Eigen::Vector2d(x, y));
  }
  return box;
}

void fit_footprint(Station& station) {
  station.footprint.setEmpty();
  const auto extend = [&](const Solid& s) {
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        station.footprint.extend(s.centre + Eigen::Rotation2Dd(s.yaw) * Eigen::Vector2d(x * s.half.x(), y * s.half.y()));
      }
    }
  };
  for (const PlannedObject& c : station.conveyors) {
    for (const Solid& s : c.solids()) extend(s);
  }
  for (const PlacedItem& item : station.supports) extend(solid_of(item.item.extent, item.at));
}

builder::TableTopConveyor draw_table_top(Dice& dice, const ConveyorFinishes& finishes) {
  builder::TableTopConveyor c;
  // Most are like the AgiProbot's units, some are not.
  const bool usual = dice.chance(0.65);
  c.length = to_mm(usual ? dice.between(0.56, 0.66) : dice.between(0.42, 0.90));
  c.width = to_mm(usual ? dice.between(0.37, 0.43) : std::min(0.9 * c.length, dice.between(0.28, 0.52)));
  c.height = to_mm(usual ? dice.between(0.14, 0.16) : dice.between(0.11, 0.20));
  c.rollers = dice.chance(0.45);
  c.roller_pitch = to_mm(dice.between(0.056, 0.075));
  c.rail = dice.pick(finishes.rails);
  c.belt = dice.pick(finishes.belts);
  c.roller = dice.pick(finishes.rollers);
  return c;
}

ObjectPart draw_floor_part(Dice& dice, const ConveyorFinishes& finishes, double width, double height, bool curve) {
  const std::string frame = dice.pick(finishes.rails), belt = dice.pick(finishes.belts), roller = dice.pick(finishes.rollers);
  if (curve) {
    builder::CurveConveyor c;
    c.width = width;
    c.height = height;
    c.radius = to_mm(dice.between(std::max(0.55, 0.75 * width + 0.25), 0.95));
    c.degrees = dice.whole(45, 90);
    c.belt = dice.chance(0.4);
    c.frame = frame;
    c.belt_finish = belt;
    c.roller = roller;
    return c;
  }
  builder::FloorConveyor c;
  c.length = to_mm(dice.between(0.9, 1.7));
  c.width = width;
  c.height = height;
  c.rollers = dice.chance(0.55);
  c.roller_pitch = to_mm(dice.between(0.075, 0.11));
  c.frame = frame;
  c.belt = belt;
  c.roller = roller;
  return c;
}

}  // namespace

Station draw_table_top_station(Dice& dice, const ConveyorFinishes& finishes, int count, double apart) {
  Station station;
  std::vector<builder::TableTopConveyor> parts;
  std::vector<Eigen::AlignedBox2d> boxes;
  std::vector<double> yaws;
  double width = (count - 1) * apart, depth = 0.0;
  for (int i = 0; i < count; ++i) {
    parts.push_back(draw_table_top(dice, finishes));
    // Some stand end on. Neighbours are nearly parallel.
    const double most = count > 1 ? 1.5 : 8.0;
    yaws.push_back((dice.chance(0.12) ? 90.0 : 0.0) + dice.between(-most, most));
    boxes.push_back(turned_extent(parts.back(), yaws.back()));
    width += boxes.back().sizes().x();
    depth = std::max(depth, boxes.back().sizes().y());
  }
  double tallest = 0.0;
  for (const auto& part : parts) tallest = std::max(tallest, part.height);
  const double front_gap = dice.between(0.03, 0.09);
  const double top_width = to_mm(width + dice.between(0.14, 0.55)),
               top_depth = to_mm(std::max(0.5, depth + front_gap + dice.between(0.05, 0.32)));
  const double height = to_mm(dice.between(0.62, std::min(0.85, 1.02 - tallest)));
  const bool on_table = dice.chance(0.3);
  const bool drawers = dice.chance(0.5), shelf = dice.chance(0.5), wood = dice.chance(0.5);
  const Item support =
      on_table ? table(top_width, top_depth, height, wood ? "beech" : "table_top", shelf) : cabinet(top_width, top_depth, height, drawers);
  station.supports.push_back({support, {}});
  station.tops.push_back({{0, 0, height, 0}, top_width, top_depth});
  double x = -width / 2 + dice.between(-0.4, 0.4) * (top_width - width) / 2;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double y = -top_depth / 2 + front_gap - boxes[k].min().y();
    station.conveyors.push_back({"", parts[k], {x - boxes[k].min().x(), y, height, yaws[k]}});
    x += boxes[k].sizes().x() + apart;
  }
  fit_footprint(station);
  return station;
}

Station draw_floor_station(Dice& dice, const ConveyorFinishes& finishes, int count, double apart) {
  Station station;
  const double width = to_mm(dice.between(0.40, 0.70)), height = to_mm(dice.between(0.60, 0.88));
  double x = 0.0;
  for (int i = 0; i < count; ++i) {
    const bool curve = dice.chance(count > 1 ? (i == 0 ? 0.0 : 0.5) : 0.3);
    const ObjectPart part = draw_floor_part(dice, finishes, width, height, curve);
    if (curve && count > 1) {
      // It begins where the segment before it ends, `apart` behind: its first edge faces -x.
      const auto& c = std::get<builder::CurveConveyor>(part);
      station.conveyors.push_back({"", part, {x, c.radius, 0, -90.0}});
    } else if (curve) {
      const Eigen::AlignedBox2d box = turned_extent(part, 0.0);
      const double yaw = dice.between(0, 360);
      const Eigen::Vector2d middle = Eigen::Rotation2Dd(to_radians(yaw)) * box.center();
      station.conveyors.push_back({"", part, {-middle.x(), -middle.y(), 0, yaw}});
    } else {
      const double length = std::get<builder::FloorConveyor>(part).length;
      station.conveyors.push_back({"", part, {x + length / 2, 0, 0, dice.between(-0.8, 0.8)}});
      x += length + apart;
    }
  }
  // Along the wall or away from it.
  const double turn = count > 1 ? dice.between(-4, 4) : (dice.chance(0.3) ? 90.0 : 0.0) + dice.between(-9, 9);
  fit_footprint(station);
  const Eigen::Vector2d middle = station.footprint.center();
  for (PlannedObject& c : station.conveyors) {
    c.at = placed({0, 0, 0, turn}, placed({-middle.x(), -middle.y(), 0, 0}, c.at));
  }
  fit_footprint(station);
  const bool curved = std::holds_alternative<builder::CurveConveyor>(station.conveyors.back().part);
  station.sides_matter = curved || station.footprint.sizes().y() > station.footprint.sizes().x();
  return station;
}

Station draw_line(Dice& dice, const ConveyorFinishes& finishes, int count) {
  Station station;
  const double width = to_mm(dice.between(0.45, 0.70)), height = to_mm(dice.between(0.65, 0.85));
  Eigen::Vector2d end(0, 0);
  double heading = 0.0;
  int curves = 0;
  const double turn_side = dice.sign();
  for (int i = 0; i < count; ++i) {
    const double apart = to_mm(dice.between(0.01, 0.03));
    const bool curve = i > 0 && i + 1 < count && curves < 2 && dice.chance(0.35);
    const ObjectPart part = draw_floor_part(dice, finishes, width, height, curve);
    const auto forward = [&] { return Eigen::Vector2d(std::cos(to_radians(heading)), std::sin(to_radians(heading))); };
    const auto left = [&] { return Eigen::Vector2d(-forward().y(), forward().x()); };
    if (curve) {
      const auto& c = std::get<builder::CurveConveyor>(part);
      const Eigen::Vector2d centre = end + turn_side * c.radius * left();
      // A left turn sweeps on from the end's own angle, a right turn back from it.
      const double first = turn_side > 0 ? heading - 90 : heading + 90 - c.degrees;
      station.conveyors.push_back({"", part, {centre.x(), centre.y(), 0, first}});
      heading += turn_side * c.degrees;
      end = centre - turn_side * c.radius * left() + apart * forward();
      ++curves;
    } else {
      const double length = std::get<builder::FloorConveyor>(part).length;
      const Eigen::Vector2d middle = end + 0.5 * length * forward();
      station.conveyors.push_back({"", part, {middle.x(), middle.y(), 0, heading}});
      end += (length + apart) * forward();
    }
  }
  fit_footprint(station);
  const Eigen::Vector2d middle = station.footprint.center();
  for (PlannedObject& c : station.conveyors) {
    c.at.x -= middle.x();
    c.at.y -= middle.y();
  }
  fit_footprint(station);
  return station;
}

void place_station(HallPlan& plan, const Station& station, const Placement& at) {
  for (PlannedObject c : station.conveyors) {
    c.name = "conveyor_" + std::to_string(plan.objects.size() + 1);
    c.at = placed(at, c.at);
    for (const Solid& solid : c.solids()) plan.solids.push_back(solid);
    plan.objects.push_back(c);
  }
  for (const PlacedItem& support : station.supports) plan.add(support.item, placed(at, support.at));
}

}  // namespace waretwin::generate
