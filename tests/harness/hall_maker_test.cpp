// Random halls on disk: what is promised of them holds on the written files.
#include "harness/generate/hall_maker.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "core/parallel.h"
#include "scenes/scenario.h"
#include "sim/motion/hall_motion.h"
#include "sim/visibility.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

generate::GenerateConfig cell(std::uint64_t seed) {
  generate::GenerateConfig config;
  config.seed = seed;
  return config;
}

TEST(HallMaker, ShowsEveryConveyorAndTouchesNothing) {
  for (const std::uint64_t seed : {2, 10}) {
    SCOPED_TRACE(seed);
    const test::TemporaryFolder folder;
    const fs::path place = folder.path() / "hall";
    const MadeHall made = make_hall(cell(seed), place);
    EXPECT_GE(made.objects.size(), 3u);
    EXPECT_LE(made.objects.size(), 6u);
    for (const char* name : {"scenario.yaml", "hall.glb", "plan.png"}) EXPECT_TRUE(fs::exists(place / name)) << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1) << "nothing is left beside it";

    const Scenario scenario = load_scenario(place / "scenario.yaml");
    const auto caster = std::make_shared<RayCaster>(std::make_shared<const Scene>(build_scene(scenario)));
    HallMotion motion(scenario, *caster);
    EXPECT_NEAR(to_seconds(motion.duration()), made.route_s, 1e-6);
    SurfaceCoverage coverage(caster, scenario.sensors.cameras, scenario.robot);
    // With the wheels' slip, as a run drives.
    for (Stamp stamp = 0; stamp <= motion.duration(); stamp += 1'000'000'000) {
      motion.advance_to(stamp);
      for (const auto& [name, camera] : scenario.sensors.cameras) coverage.add_frame(name, motion.X_WB(stamp) * camera.mount.X_BC());
    }
    motion.advance_to(motion.duration());
    EXPECT_TRUE(motion.report().contacts.empty());
    for (const MadeObject& conveyor : made.objects) {
      EXPECT_GE(conveyor.coverage, 0.8) << conveyor.object.name;
      EXPECT_GE(coverage.fraction(conveyor.object.id), 0.79) << conveyor.object.name;
      EXPECT_GE(conveyor.stops, 2) << conveyor.object.name;
    }
  }
}

TEST(HallMaker, ShowsWhatStandsInAHome) {
  const test::TemporaryFolder folder;
  generate::GenerateConfig config = cell(4);
  config.style = "home";
  const MadeHall made = make_hall(config, folder.path() / "hall");
  EXPECT_EQ(made.what, "objects");
  const Scenario scenario = load_scenario(folder.path() / "hall" / "scenario.yaml");
  const auto caster = std::make_shared<RayCaster>(std::make_shared<const Scene>(build_scene(scenario)));
  HallMotion motion(scenario, *caster);
  motion.advance_to(motion.duration());
  EXPECT_TRUE(motion.report().contacts.empty());
  ASSERT_FALSE(made.objects.empty());
  for (const MadeObject& object : made.objects) EXPECT_GE(object.coverage, 0.8) << object.object.name;
}

TEST(HallMaker, GivesTheSameBytesAtAnyNumberOfThreads) {
  const test::TemporaryFolder folder;
  set_thread_count(1);
  make_hall(cell(3), folder.path() / "one");
  set_thread_count(4);
  make_hall(cell(3), folder.path() / "four");
  set_thread_count(0);
  for (const char* name : {"scenario.yaml", "hall.glb", "plan.png"}) {
    EXPECT_TRUE(read_file(folder.path() / "one" / name) == read_file(folder.path() / "four" / name)) << name;
  }
}

TEST(HallMaker, ReplacesOnlyItsOwnHalls) {
  const test::TemporaryFolder folder;
  const fs::path place = folder.path() / "hall";
  generate::GenerateConfig config = cell(1);
  config.coverage = 0;
  config.conveyors = 1;
  config.clutter = 0;
  make_hall(config, place);
  const std::string first = read_file(place / "scenario.yaml");
  config.seed = 2;
  make_hall(config, place);
  EXPECT_NE(read_file(place / "scenario.yaml"), first);
  write_file(place / "notes.txt", "mine");
  EXPECT_ERROR(make_hall(config, place), "notes.txt");
  fs::remove(place / "notes.txt");
  write_file(place / "scenario.yaml", "name: my own\n");
  EXPECT_ERROR(make_hall(config, place), "scenario.yaml", "generate");
  EXPECT_EQ(read_file(place / "scenario.yaml"), "name: my own\n");
}

TEST(HallMaker, SaysWhenThereIsNoRoom) {
  const test::TemporaryFolder folder;
  generate::GenerateConfig config = cell(1);
  config.length_m = 5;
  config.width_m = 4.5;
  config.conveyors = 12;
  EXPECT_ERROR(make_hall(config, folder.path() / "hall"), "5x4.5", "no room", "12 conveyors");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace waretwin
