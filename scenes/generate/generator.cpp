#include "scenes/generate/generator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "scenes/generate/cell.h"
#include "scenes/generate/dice.h"
#include "scenes/generate/flat.h"
#include "scenes/generate/home.h"
#include "scenes/generate/warehouse.h"

namespace waretwin::generate {

namespace {

constexpr double kSmallestRoom = 2.5;  // metres: a bathroom
constexpr double kSmallestSide = 4.0;  // metres: a station, and before it a vehicle that turns

std::string size_text(const GenerateConfig& c) {
  char text[64];
  std::snprintf(text, sizeof text, "%gx%g", c.length_m, c.width_m);
  return text;
}

// The vehicle has worn its way into the floor: along part of the route.
void add_tyre_marks(HallPlan& plan, Dice& dice) {
  const auto& route = plan.robot.route;
  const int count = static_cast<int>(route.size());
  for (int k = dice.whole(1, 3); k > 0 && count > 4; --k) {
    const int first = dice.whole(0, count - 4), last = std::min(count - 1, first + dice.whole(3, 6));
    FloorMark mark{{}, 0.12, ""};
    for (int i = first; i <= last; ++i) {
      const Eigen::Vector2d p(to_mm(route[static_cast<std::size_t>(i)].x_m + dice.between(-0.05, 0.05)),
                              to_mm(route[static_cast<std::size_t>(i)].y_m + dice.between(-0.05, 0.05)));
      if (mark.path.empty() || (p - mark.path.back()).norm() > 0.35) mark.path.push_back(p);
    }
    if (mark.path.size() > 2) plan.marks.push_back(mark);
  }
}

}  // namespace

Generator::Generator(const GenerateConfig& config) : config_(config), vehicle_(vehicle_of(config.style)) {
  const bool home = config.style == "home";
  if (home && config.conveyors > 0) {
    throw Error("conveyors " + std::to_string(config.conveyors) +
                ": a home has none; expected style cell, warehouse or flat, or no number");
  }
  const double smallest = home ? kSmallestRoom : kSmallestSide;
  for (const double side : {config.length_m, config.width_m}) {
    if (side > 0 && side < smallest) {
      throw Error("size " + size_text(config) + ": too small for a vehicle to turn before " +
                  (home ? "furniture; expected at least 2.5x2.5 m" : "a conveyor; expected at least 4x4 m"));
    }
  }
}

RouteWishes Generator::wishes(const HallPlan& plan, int attempt) const {
  Dice dice(config_.seed, "route", attempt);
  return {.clearance_m = config_.clearance_m, .wait_s = config_.wait_s, .start = plan.entrance, .back_to_start = dice.chance(0.35)};
}

std::vector<Stop> Generator::possible_stops(const HallPlan& plan, int attempt, std::size_t object) const {
  return generate::possible_stops(plan, wishes(plan, attempt), object);
}

void Generator::add_stops(HallPlan& plan, int attempt, const std::vector<Stop>& stops) const {
  generate::add_stops(plan, wishes(plan, attempt), stops);
}

std::optional<HallPlan> Generator::draw(int attempt) const {
  std::optional<HallPlan> plan = config_.style == "cell"   ? draw_cell(config_, attempt)
                                 : config_.style == "flat" ? draw_flat(config_, attempt)
                                 : config_.style == "home" ? draw_home(config_, attempt)
                                                           : draw_warehouse(config_, attempt);
  if (!plan) return std::nullopt;
  plan->robot = vehicle_.robot;
  plan->sensors = vehicle_.sensors;
  if (!plan_route(*plan, vehicle_.camera, wishes(*plan, attempt)).empty()) return std::nullopt;
  Dice dice(config_.seed, "marks", attempt);
  if (config_.style != "flat" && config_.style != "home") add_tyre_marks(*plan, dice);
  return plan;
}

}  // namespace waretwin::generate
