// The hall generator: what it promises of its plans, held against the built and loaded halls.
#include "scenes/generate/generator.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/files.h"
#include "core/pose.h"
#include "core/random.h"
#include "scenes/generate/free_space.h"
#include "scenes/generate/hall_files.h"
#include "scenes/generate/home.h"
#include "scenes/generate/station.h"
#include "scenes/generate/vehicle.h"
#include "scenes/scenario.h"
#include "tests/scenes/hall_checks.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin::generate {
namespace {

HallPlan planned(const GenerateConfig& config) {
  const Generator generator(config);
  for (int attempt = 0; attempt < 30; ++attempt) {
    std::optional<HallPlan> plan = generator.draw(attempt);
    if (plan) return *std::move(plan);
  }
  ADD_FAILURE() << config.style << " seed " << config.seed << ": no draw works out";
  return {};
}

GenerateConfig cell(std::uint64_t seed) {
  GenerateConfig config;
  config.seed = seed;
  return config;
}

struct LoadedHall {
  Scenario scenario;
  Scene scene;
};

LoadedHall load(const HallPlan& plan, std::uint64_t seed) {
  const test::TemporaryFolder folder;
  write_file(folder.path() / "hall.glb", build_glb(plan));
  write_file(folder.path() / "scenario.yaml", scenario_text(plan, seed));
  LoadedHall hall;
  hall.scenario = load_scenario(folder.path() / "scenario.yaml");
  hall.scene = build_scene(hall.scenario);
  return hall;
}

TEST(GeneratedCells, KeepTheirPromisesOnPaper) {
  std::set<std::string> kinds;
  std::set<std::size_t> counts;
  int close_pairs = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const HallPlan plan = planned(cell(seed));
    EXPECT_GE(plan.objects.size(), 3u);
    EXPECT_LE(plan.objects.size(), 6u);
    counts.insert(plan.objects.size());
    std::vector<int> stops(plan.objects.size(), 0);
    for (const Stop& stop : plan.stops) ++stops[static_cast<std::size_t>(stop.object)];
    for (std::size_t i = 0; i < plan.objects.size(); ++i) {
      const PlannedObject& c = plan.objects[i];
      kinds.insert(c.kind());
      EXPECT_GE(stops[i], 2) << c.name;
      EXPECT_GT(std::abs(c.at.yaw_deg - std::round(c.at.yaw_deg)), 0.1) << c.name << " stands on the grid of whole degrees";
      for (std::size_t k = i + 1; k < plan.objects.size(); ++k) {
        double between = 1e9;
        for (const Solid& a : c.solids()) {
          for (const Solid& b : plan.objects[k].solids()) between = std::min(between, gap(a, b));
        }
        EXPECT_GT(between, 0.01) << c.name << ", " << plan.objects[k].name;
        close_pairs += between < 0.32 ? 1 : 0;
      }
    }
    const auto owner = [&](const Solid& solid) {
      for (std::size_t i = 0; i < plan.objects.size(); ++i) {
        for (const Solid& s : plan.objects[i].solids()) {
          if (s.centre == solid.centre && s.low == solid.low) return static_cast<int>(i);
        }
      }
      return -1;
    };
    for (std::size_t i = 0; i < plan.solids.size(); ++i) {
      for (std::size_t k = i + 1; k < plan.solids.size(); ++k) {
        if (owner(plan.solids[i]) >= 0 && owner(plan.solids[i]) == owner(plan.solids[k])) continue;  // pieces of one curve
        EXPECT_FALSE(collide(plan.solids[i], plan.solids[k], 0.0)) << "solids " << i << " and " << k;
      }
    }
  }
  EXPECT_GE(kinds.size(), 5u) << "of table-top, floor and curve, each with belt or rollers";
  EXPECT_GE(counts.size(), 3u);
  EXPECT_GE(close_pairs, 1);
  EXPECT_LE(close_pairs, 12);
}

TEST(GeneratedCells, AreWhatTheyWereOnPaperOnceBuilt) {
  for (const std::uint64_t seed : {3, 8}) {
    SCOPED_TRACE(seed);
    const HallPlan plan = planned(cell(seed));
    const LoadedHall hall = load(plan, seed);
    EXPECT_TRUE(hall.scene.notes.empty()) << hall.scene.notes.front();
    EXPECT_EQ(hall.scenario.seed, seed);
    EXPECT_EQ(hall.scenario.robot.route.size(), plan.robot.route.size());
    ASSERT_EQ(hall.scene.objects.size(), plan.objects.size());
    for (const PlannedObject& c : plan.objects) {
      SCOPED_TRACE(c.name);
      const auto found =
          std::find_if(hall.scene.objects.begin(), hall.scene.objects.end(), [&](const TrueObject& o) { return o.name == c.name; });
      ASSERT_NE(found, hall.scene.objects.end());
      EXPECT_EQ(found->class_name, "conveyor");
      if (std::holds_alternative<builder::CurveConveyor>(c.part)) continue;  // its box is no edge of it
      const Eigen::Vector3d size = extent_of(c.part).sizes();
      EXPECT_NEAR(found->cuboid.size.x(), std::max(size.x(), size.y()), 0.002);
      EXPECT_NEAR(found->cuboid.size.y(), std::min(size.x(), size.y()), 0.002);
      EXPECT_NEAR(found->cuboid.size.z(), size.z(), 0.002);
      EXPECT_LT((found->cuboid.centre - c.middle()).norm(), 0.003);
      const double yaw = to_radians(c.at.yaw_deg) + (size.x() < size.y() ? std::numbers::pi / 2 : 0.0);
      EXPECT_LT(to_degrees(angle_distance(found->cuboid.yaw, yaw, std::numbers::pi)), 0.01);
      const test::Solid below = test::solid_of(found->cuboid, 0.05, found->cuboid.bottom() - 0.002, found->cuboid.bottom() + 0.0005);
      EXPECT_FALSE(test::background_in(hall.scene, below).empty()) << "floats";
      const bool table_top = std::holds_alternative<builder::TableTopConveyor>(c.part);
      const std::set<std::string> cut = test::background_in(hall.scene, test::solid_of(found->cuboid, 0.003, found->cuboid.bottom() + 0.003,
                                                                                       found->cuboid.top() + (table_top ? 0.05 : -0.08)));
      EXPECT_TRUE(cut.empty()) << test::joined(cut);
    }
    const std::set<std::string> met = test::on_the_route(hall.scene, hall.scenario.robot, 0.05);
    EXPECT_TRUE(met.empty()) << test::joined(met);
    for (const Mesh& mesh : hall.scene.meshes) {
      const Material& material = hall.scene.materials[static_cast<std::size_t>(mesh.material)];
      EXPECT_GE(material.reflectivity_850nm, 0.05f) << material.name;
      EXPECT_LE(material.reflectivity_850nm, 0.95f) << material.name;
    }
  }
}

TEST(GeneratedCells, TheSameSeedGivesTheSameBytes) {
  const HallPlan first = planned(cell(5)), second = planned(cell(5)), other = planned(cell(6));
  EXPECT_TRUE(build_glb(first) == build_glb(second));
  EXPECT_EQ(scenario_text(first, 5), scenario_text(second, 5));
  EXPECT_NE(scenario_text(first, 5), scenario_text(other, 5));
}

TEST(GeneratedCells, TakeTheSizeAndTheNumberThatOneAsksFor) {
  GenerateConfig config = cell(4);
  config.length_m = 9.5;
  config.width_m = 7.25;
  config.conveyors = 2;
  config.clutter = 0;
  const HallPlan plan = planned(config);
  EXPECT_EQ(plan.objects.size(), 2u);
  EXPECT_EQ(plan.length, 9.5);
  EXPECT_EQ(plan.width, 7.25);
  GenerateConfig small = config;
  small.width_m = 3.0;
  EXPECT_ERROR(Generator{small}, "9.5x3", "4x4");
}

TEST(GeneratedCells, ClutterIsWhatOneAsksFor) {
  GenerateConfig bare = cell(9), crowded = cell(9);
  bare.clutter = 0;
  crowded.clutter = 1;
  EXPECT_LT(planned(bare).items.size() + 10, planned(crowded).items.size());
}

TEST(GeneratedWarehouses, HoldLinesThatVehiclesDriveAround) {
  GenerateConfig config;
  config.style = "warehouse";
  int bolted = 0;
  std::set<std::string> kinds;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(seed);
    config.seed = seed;
    const HallPlan plan = planned(config);
    EXPECT_GE(plan.objects.size(), 6u);
    EXPECT_LE(plan.objects.size(), 10u);
    EXPECT_GT(plan.length * plan.width, 150.0);
    EXPECT_GT(plan.items.size(), 10u);
    const LoadedHall hall = load(plan, seed);
    ASSERT_EQ(hall.scene.objects.size(), plan.objects.size());
    EXPECT_LT(hall.scene.triangle_count(), 1'500'000u);
    const std::set<std::string> met = test::on_the_route(hall.scene, hall.scenario.robot, 0.05);
    EXPECT_TRUE(met.empty()) << test::joined(met);
    for (std::size_t i = 0; i < plan.objects.size(); ++i) {
      kinds.insert(plan.objects[i].kind());
      for (std::size_t k = i + 1; k < plan.objects.size(); ++k) {
        const auto* a = std::get_if<builder::FloorConveyor>(&plan.objects[i].part);
        const auto* b = std::get_if<builder::FloorConveyor>(&plan.objects[k].part);
        if (!a || !b) continue;
        const double between = gap(plan.objects[i].solids()[0], plan.objects[k].solids()[0]);
        EXPECT_GT(between, 0.005) << plan.objects[i].name << ", " << plan.objects[k].name;
        bolted += between < 0.04 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(bolted, 2);
  EXPECT_GE(kinds.size(), 4u);
}

// Of a line's curves the real triangles count: the boxes that stand for them on paper reach a little farther.
TEST(GeneratedWarehouses, LinesDoNotCutIntoThemselves) {
  Dice dice(7, "test lines");
  const ConveyorFinishes finishes{{"green_paint"}, {"rubber_belt"}, {"roller_steel"}};
  int curves = 0;
  for (int i = 0; i < 24; ++i) {
    SCOPED_TRACE(i);
    const Station line = draw_line(dice, finishes, 4);
    ASSERT_EQ(line.conveyors.size(), 4u);
    for (std::size_t k = 1; k < line.conveyors.size(); ++k) {
      curves += std::holds_alternative<builder::CurveConveyor>(line.conveyors[k].part) ? 1 : 0;
      // Top patches of one lie outside the other, and the nearest two within a few centimetres.
      double nearest = 1e9;
      for (const SurfacePatch& a : line.conveyors[k - 1].surface()) {
        for (const SurfacePatch& b : line.conveyors[k].surface()) {
          if (a.normal.z() > 0.9 && b.normal.z() > 0.9) nearest = std::min(nearest, (a.p_W - b.p_W).head<2>().norm());
        }
      }
      EXPECT_LT(nearest, 0.15);
      EXPECT_GT(nearest, 0.03);
    }
  }
  EXPECT_GE(curves, 5);
}

TEST(GeneratedFlats, AreBareAndSmall) {
  GenerateConfig config;
  config.style = "flat";
  const HallPlan plan = planned(config);
  EXPECT_GE(plan.objects.size(), 2u);
  EXPECT_LE(plan.objects.size(), 3u);
  EXPECT_LT(build_glb(plan).size(), 600'000u);
  for (const PlannedObject& c : plan.objects) EXPECT_TRUE(c.kind().starts_with("table-top")) << c.kind();
  for (const PlannedWall& wall : plan.walls) EXPECT_TRUE(wall.openings.empty());
}

GenerateConfig home(std::uint64_t seed) {
  GenerateConfig config;
  config.style = "home";
  config.seed = seed;
  return config;
}

TEST(GeneratedHomes, KeepTheirPromisesOnPaper) {
  std::set<std::string> classes, titles;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const HallPlan plan = planned(home(seed));
    titles.insert(plan.title);
    ASSERT_FALSE(plan.objects.empty());
    std::vector<int> stops(plan.objects.size(), 0);
    for (const Stop& stop : plan.stops) ++stops[static_cast<std::size_t>(stop.object)];
    std::set<std::string> names;
    for (std::size_t i = 0; i < plan.objects.size(); ++i) {
      const PlannedObject& object = plan.objects[i];
      classes.insert(std::get<FurniturePart>(object.part).class_name);
      names.insert(object.name);
      EXPECT_GE(stops[i], 2) << object.name;
      EXPECT_GT(std::abs(object.at.yaw_deg - std::round(object.at.yaw_deg)), 0.1) << object.name << " stands on the grid of whole degrees";
    }
    EXPECT_EQ(names.size(), plan.objects.size());
    EXPECT_EQ(plan.robot.width_m, vehicle_of("home").robot.width_m);
  }
  EXPECT_EQ(classes, std::set<std::string>(home_classes().begin(), home_classes().end()));
  EXPECT_GE(titles.size(), 5u);
}

TEST(GeneratedHomes, AreFurnishedSoThatNothingCutsIntoAnObject) {
  for (const std::uint64_t seed : {2, 7, 8}) {
    SCOPED_TRACE(seed);
    const HallPlan plan = planned(home(seed));
    const LoadedHall hall = load(plan, seed);
    EXPECT_TRUE(hall.scene.notes.empty()) << hall.scene.notes.front();
    ASSERT_EQ(hall.scene.objects.size(), plan.objects.size());
    for (std::size_t i = 0; i < hall.scene.objects.size(); ++i) {
      const TrueObject& object = hall.scene.objects[i];
      const auto found =
          std::find_if(plan.objects.begin(), plan.objects.end(), [&](const PlannedObject& o) { return o.name == object.name; });
      ASSERT_NE(found, plan.objects.end());
      const auto& part = std::get<FurniturePart>(found->part);
      EXPECT_EQ(object.class_name, part.class_name);
      EXPECT_NEAR(object.cuboid.bottom(), found->at.z, 0.002) << object.name;
      EXPECT_NEAR(object.cuboid.size.z(), part.extent.sizes().z(), 0.002) << object.name;
      // The minimum-area box is never larger than the part's own.
      EXPECT_LE(object.cuboid.size.x() * object.cuboid.size.y(), part.extent.sizes().x() * part.extent.sizes().y() + 1e-3) << object.name;
      const std::set<std::string> below =
          test::things_in(hall.scene, test::solid_of(object.cuboid, 0.02, object.cuboid.bottom() - 0.002, object.cuboid.bottom() + 0.0005),
                          [&](const Instance& instance) { return instance.object != static_cast<int>(i); });
      EXPECT_FALSE(below.empty()) << object.name << " floats";
      const std::set<std::string> cut = test::cuts_into(hall.scene, static_cast<int>(i));
      EXPECT_TRUE(cut.empty()) << object.name << " is cut by " << test::joined(cut);
    }
    const std::set<std::string> met = test::on_the_route(hall.scene, hall.scenario.robot, 0.05);
    EXPECT_TRUE(met.empty()) << test::joined(met);
    // What the route was planned for is what drives there.
    const CameraConfig& camera = hall.scenario.sensors.cameras.at("camera");
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.mount.pitch_deg, vehicle_of("home").camera.mount.pitch_deg);
    EXPECT_EQ(hall.scenario.robot.drive.track_m, vehicle_of("home").robot.drive.track_m);
    EXPECT_EQ(hall.scenario.robot.length_m, vehicle_of("home").robot.length_m);
    for (const Mesh& mesh : hall.scene.meshes) {
      const Material& material = hall.scene.materials[static_cast<std::size_t>(mesh.material)];
      EXPECT_GE(material.reflectivity_850nm, 0.05f) << material.name;
      EXPECT_LE(material.reflectivity_850nm, 0.95f) << material.name;
    }
  }
}

TEST(GeneratedHomes, TheSameSeedGivesTheSameBytes) {
  const HallPlan first = planned(home(5)), second = planned(home(5)), other = planned(home(6));
  EXPECT_TRUE(build_glb(first) == build_glb(second));
  EXPECT_LT(build_glb(first).size(), 4u << 20);
  EXPECT_EQ(scenario_text(first, 5), scenario_text(second, 5));
  EXPECT_NE(scenario_text(first, 5), scenario_text(other, 5));
}

TEST(GeneratedHomes, TakeASizeButNoConveyors) {
  GenerateConfig config = home(9);
  config.length_m = 6.5;
  config.width_m = 5.25;
  const HallPlan plan = planned(config);
  EXPECT_EQ(plan.length, 6.5);
  EXPECT_EQ(plan.width, 5.25);
  GenerateConfig with_conveyors = config, small = config;
  with_conveyors.conveyors = 5;
  EXPECT_ERROR(Generator{with_conveyors}, "conveyors 5", "home");
  small.width_m = 2.0;
  EXPECT_ERROR(Generator{small}, "6.5x2", "2.5x2.5");
}

// Footprints against points of a fine grid.
TEST(PlannedObjects, SurfaceOfACurveLiesOnIt) {
  PlannedObject conveyor;
  builder::CurveConveyor curve;
  curve.belt = false;
  conveyor.part = curve;
  // What has been given back is filled with other numbers: whoever still reads it gets patches from anywhere.
  mallopt(M_PERTURB, 0x5a);
  const std::vector<SurfacePatch> patches = conveyor.surface();
  mallopt(M_PERTURB, 0);
  const Eigen::AlignedBox3d extent = extent_of(curve);
  ASSERT_GT(patches.size(), 50u);
  for (const SurfacePatch& patch : patches) {
    EXPECT_LT(extent.exteriorDistance(patch.p_W), 0.03) << patch.p_W.transpose();
    EXPECT_NEAR(patch.normal.norm(), 1.0, 1e-9);
  }
}

TEST(Solids, GapsAndOverlapsAgreeWithPoints) {
  const RandomStream random(3, "test", "solids");
  int overlapping = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto draw = [&](std::uint32_t k, double low, double high) { return low + (high - low) * random.uniform(i, k); };
    const Solid a{{draw(0, -1, 1), draw(1, -1, 1)}, {draw(2, 0.1, 0.6), draw(3, 0.1, 0.6)}, draw(4, 0, 3.2), 0, 1};
    const Solid b{{draw(5, -1, 1), draw(6, -1, 1)}, {draw(7, 0.1, 0.6), draw(8, 0.1, 0.6)}, draw(9, 0, 3.2), 0.5, 2};
    double nearest = 1e9;
    constexpr int kSteps = 40;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; v <= kSteps; ++v) {
        const Eigen::Vector2d local(a.half.x() * (2.0 * u / kSteps - 1), a.half.y() * (2.0 * v / kSteps - 1));
        nearest = std::min(nearest, distance(a.centre + Eigen::Rotation2Dd(a.yaw) * local, b));
      }
    }
    constexpr double kGrid = 0.03;
    overlapping += nearest == 0.0 ? 1 : 0;
    EXPECT_NEAR(gap(a, b), gap(b, a), 1e-12);
    if (nearest == 0.0) {
      EXPECT_LE(gap(a, b), 1e-9);
    } else {
      EXPECT_LE(gap(a, b), nearest + 1e-9);
      EXPECT_GE(gap(a, b), 0.7 * nearest - kGrid);
    }
    EXPECT_EQ(collide(a, b, 0.0), gap(a, b) < 0);
    Solid above = b;
    above.low = 1.0;
    EXPECT_FALSE(collide(a, above, 0.5)) << "one stands on the other";
  }
  EXPECT_GT(overlapping, 50);
}

TEST(Solids, HideWhatLiesBehindThem) {
  const Solid box{{1, 0}, {0.2, 0.3}, 0.3, 0.0, 1.0};
  EXPECT_TRUE(blocks(box, {0, 0, 0.5}, {2, 0, 0.5}));
  EXPECT_FALSE(blocks(box, {0, 0, 0.5}, {0.5, 0, 0.5})) << "ends before it";
  EXPECT_FALSE(blocks(box, {0, 0, 1.2}, {2, 0, 1.1})) << "passes above";
  EXPECT_TRUE(blocks(box, {0, 0, 1.5}, {2, 0, 0.1}));
  EXPECT_FALSE(blocks(box, {0, 1, 0.5}, {2, 1, 0.5}));
}

TEST(FreeSpaceTest, FindsTheWayRoundAWall) {
  HallPlan plan;
  plan.length = 8;
  plan.width = 6;
  plan.solids = {{{0, -1}, {0.1, 2.0}, 0, 0, 2}, {{3, 0}, {0.2, 0.2}, 0, 1.8, 2.5}};  // a wall with an opening in the north; a lamp
  const double radius = 0.6;
  const FreeSpace space(plan, radius);
  ASSERT_FALSE(space.places().empty());
  for (const Eigen::Vector2d& p : space.places()) {
    EXPECT_GE(distance(p, plan.solids[0]), radius);
    EXPECT_LE(std::abs(p.x()), 4 - radius + 1e-9);
    EXPECT_LE(std::abs(p.y()), 3 - radius + 1e-9);
  }
  const std::size_t from = space.nearest({-1, -2}), to = space.nearest({1, -2});
  const std::vector<Eigen::Vector2d> way = space.way(from, to);
  EXPECT_GE(way.size(), 3u);
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_TRUE(space.clear(way[i - 1], way[i]));
    length += (way[i] - way[i - 1]).norm();
  }
  EXPECT_EQ(way.front(), space.places()[from]);
  EXPECT_EQ(way.back(), space.places()[to]);
  EXPECT_GT(length, 7.0);
  EXPECT_LE(length, 1.02 * space.distances(from)[to]);
  EXPECT_FALSE(space.clear(space.places()[from], space.places()[to]));
  // A wall from side to side leaves the larger half.
  plan.solids[0] = {{1.0, 0}, {0.1, 3.0}, 0, 0, 2};
  const FreeSpace half(plan, radius);
  for (const Eigen::Vector2d& p : half.places()) EXPECT_LT(p.x(), 1.0);
}

}  // namespace
}  // namespace waretwin::generate
