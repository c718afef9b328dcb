#include "harness/generate/hall_maker.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/pose.h"
#include "core/staged_folder.h"
#include "harness/generate/plan_picture.h"
#include "harness/pictures/picture_file.h"
#include "scenes/generate/generator.h"
#include "scenes/generate/hall_files.h"
#include "sim/ray_caster.h"
#include "sim/robot.h"
#include "sim/visibility.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr int kMostDraws = 30;      // halls
constexpr int kMostExtensions = 2;  // of a route

// A folder is replaced as a whole, so nothing but an earlier generated hall may stand in it: what somebody has changed by hand or run
// there must not be lost.
void expect_replaceable(const fs::path& folder) {
  static const std::set<std::string> ours = {"scenario.yaml", "hall.glb", "plan.png"};
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw Error(folder, "is a file; expected a folder or a new name");
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!ours.contains(name)) {
      throw Error(folder,
                  "holds '" + name + "', which is no part of a generated hall; expected a new name, an empty folder or an earlier hall");
    }
  }
  const fs::path scenario = folder / "scenario.yaml";
  if (fs::exists(scenario) && read_file(scenario).find("made by `waretwin generate`") == std::string::npos) {
    throw Error(scenario, "was not made by `waretwin generate`; expected a new name or an empty folder");
  }
}

// The shares that depth views along the route see, in the order of the scene's objects.
std::vector<double> coverage_along(const Scenario& scenario, const Scene& scene, SurfaceCoverage& coverage) {
  coverage.forget_frames();
  const RobotMotion motion(scenario.robot);
  constexpr Stamp kEvery = 1'000'000'000;
  for (Stamp stamp = 0; stamp <= motion.duration(); stamp += kEvery) {
    for (const auto& [name, camera] : scenario.sensors.cameras) coverage.add_frame(name, motion.X_WB(stamp) * camera.mount.X_BC());
  }
  std::vector<double> shares;
  for (const TrueObject& object : scene.objects) shares.push_back(coverage.fraction(object.id));
  return shares;
}

// Index of the plan's object with this name.
std::size_t planned(const generate::HallPlan& plan, const std::string& name) {
  const auto found = std::find_if(plan.objects.begin(), plan.objects.end(), [&](const auto& c) { return c.name == name; });
  WARETWIN_CHECK(found != plan.objects.end(), "the built hall holds the plan's objects");
  return static_cast<std::size_t>(found - plan.objects.begin());
}

// Further stops that bring every object to the wanted share, each time the one that shows most of what is missed; `coverage` holds what
// the route sees. Empty where no stops do that.
std::vector<generate::Stop> missing_stops(const generate::GenerateConfig& config, const generate::Generator& generator,
                                          const generate::HallPlan& plan, int draw, const Scenario& scenario, const Scene& scene,
                                          SurfaceCoverage& coverage) {
  constexpr double kMargin = 0.01;      // the route's frames come once a second, at times in the middle of a turn
  constexpr double kWorthwhile = 0.01;  // share of the viewable surface that a stop must add
  constexpr std::size_t kMost = 3;      // an object
  const std::string& sensor = scenario.sensors.cameras.begin()->first;
  const CameraConfig& camera = scenario.sensors.cameras.begin()->second;
  std::vector<generate::Stop> stops;
  for (const TrueObject& object : scene.objects) {
    if (coverage.fraction(object.id) >= config.coverage) continue;
    const std::vector<generate::Stop> possible = generator.possible_stops(plan, draw, planned(plan, object.name));
    for (std::size_t count = 0; coverage.fraction(object.id) < config.coverage + kMargin; ++count) {
      std::vector<double> adds(possible.size());
      const auto pose = [&](const generate::Stop& stop) {
        return make_upright_pose(stop.place.x(), stop.place.y(), 0, to_radians(stop.heading_deg)) * camera.mount.X_BC();
      };
      parallel_for(possible.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) adds[i] = coverage.would_add(sensor, pose(possible[i]), object.id);
      });
      const auto best = std::max_element(adds.begin(), adds.end());
      if (best == adds.end() || *best < kWorthwhile || count == kMost) {
        if (coverage.fraction(object.id) >= config.coverage) break;
        return {};
      }
      stops.push_back(possible[static_cast<std::size_t>(best - adds.begin())]);
      coverage.add_frame(sensor, pose(stops.back()));
    }
  }
  return stops;
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

}  // namespace

MadeHall make_hall(const generate::GenerateConfig& config, const fs::path& folder, const HallMakerHooks& hooks) {
  expect_replaceable(folder);
  const generate::Generator generator(config);
  StagedFolder staged(folder);
  const fs::path scenario_file = staged.path() / "scenario.yaml";
  const bool home = config.style == "home";
  double best_worst = 0.0;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    if (hooks.step) hooks.step();
    std::optional<generate::HallPlan> plan = generator.draw(draw);
    if (!plan) {
      if (hooks.in_vain) hooks.in_vain("hall " + std::to_string(draw + 1) + " has no room");
      continue;
    }
    if (hooks.step) hooks.step();
    write_file(staged.path() / "hall.glb", generate::build_glb(*plan));
    if (hooks.step) hooks.step();
    write_file(scenario_file, generate::scenario_text(*plan, config.seed));
    Scenario scenario = load_scenario(scenario_file);
    const auto scene = std::make_shared<const Scene>(build_scene(scenario));
    WARETWIN_CHECK(scene->objects.size() == plan->objects.size(), "every planned object is a true object");
    SurfaceCoverage coverage(std::make_shared<RayCaster>(scene), scenario.sensors.cameras, scenario.robot);
    std::vector<double> shares = coverage_along(scenario, *scene, coverage);
    const auto enough = [&] { return std::all_of(shares.begin(), shares.end(), [&](double share) { return share >= config.coverage; }); };
    for (int again = 0; again < kMostExtensions && !enough(); ++again) {
      if (hooks.step) hooks.step();
      const std::vector<generate::Stop> stops = missing_stops(config, generator, *plan, draw, scenario, *scene, coverage);
      if (stops.empty()) break;
      generator.add_stops(*plan, draw, stops);
      write_file(scenario_file, generate::scenario_text(*plan, config.seed));
      scenario = load_scenario(scenario_file);
      shares = coverage_along(scenario, *scene, coverage);
    }
    const double worst = shares.empty() ? 0.0 : *std::min_element(shares.begin(), shares.end());
    best_worst = std::max(best_worst, worst);
    if (!enough()) {
      if (hooks.in_vain)
        hooks.in_vain("hall " + std::to_string(draw + 1) + " shows only " + percent(worst) + " of " + (home ? "an object" : "a conveyor"));
      continue;
    }

    MadeHall made;
    made.name = plan->name;
    made.what = plan->what;
    made.length_m = plan->length;
    made.width_m = plan->width;
    made.height_m = plan->height;
    made.things = static_cast<int>(plan->items.size());
    made.stops = static_cast<int>(plan->stops.size());
    const RobotMotion motion(scenario.robot);
    made.route_m = motion.distance_m();
    made.route_s = to_seconds(motion.duration());
    made.draws = draw + 1;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const std::size_t index = planned(*plan, scene->objects[i].name);
      const auto stops = std::count_if(plan->stops.begin(), plan->stops.end(),
                                       [&](const generate::Stop& stop) { return stop.object == static_cast<int>(index); });
      made.objects.push_back({scene->objects[i], plan->objects[index].kind(), shares[i], static_cast<int>(stops)});
    }
    write_png(staged.path() / "plan.png", draw_plan(*scene, scenario.robot));
    staged.commit();
    return made;
  }
  char size[64];
  std::snprintf(size, sizeof size, "%gx%g", config.length_m, config.width_m);
  const std::string where = config.length_m > 0 ? "size " + std::string(size) : "style " + config.style;
  if (best_worst > 0.0) {
    throw Error(where + ": no route of " + std::to_string(kMostDraws) + " halls shows " + percent(config.coverage) + " of every " +
                (home ? "object" : "conveyor") + " (best: " + percent(best_worst) + "); expected a lower coverage, " +
                (home ? "less clutter" : "fewer conveyors") + " or a larger hall");
  }
  throw Error(where + ": no room for " +
              (home                   ? std::string("the furniture")
               : config.conveyors > 0 ? std::to_string(config.conveyors) + " conveyors"
                                      : std::string("the conveyors")) +
              " and a vehicle that drives between them; expected " + (home ? "" : "fewer conveyors, ") + "less clutter or a larger hall");
}

}  // namespace waretwin
