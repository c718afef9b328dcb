#include "sim/laser_spot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/laser_scanner.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_mesh;
using fixtures::placed;

struct Hall {
  std::shared_ptr<const RayCaster> caster;
  Surfaces surfaces;
  explicit Hall(Scene scene) : caster(fixtures::caster_of(std::move(scene))), surfaces(caster) {}
  LaserScan scan(const LaserConfig& config) const { return spot_scan(*caster, surfaces, config, "laser", 0, at_origin); }
  static Pose at_origin(Stamp) { return make_upright_pose(0, 0, 0, 0); }
};

LaserConfig forward() {
  LaserConfig config;
  config.mount = {.z_m = 0.3};
  return config;
}

Scene wall_with_box(float wall_x, float box_x, float box_y, float reflectivity = 0.7f) {
  Scene scene = fixtures::room(-1, wall_x, -4, 4, 3, {0.7f, 0.7f, 0.7f});
  const int box = add_mesh(scene, fixtures::unit_box(), fixtures::add_material(scene, {reflectivity, reflectivity, reflectivity}));
  add_instance(scene, box, placed({box_x, box_y, 0.0f}, {wall_x - box_x, 4.0f - box_y, 3.0f}));
  return scene;
}

TEST(SpotScan, WithoutWidthIsTheIdealScan) {
  const Hall hall(fixtures::room(-3, 5, -2, 4, 3));
  LaserConfig config = forward();
  config.spot.mixed = config.spot.dropouts = false;
  const LaserScan spot = hall.scan(config), ideal = ideal_scan(*hall.caster, config, "laser", 0, Hall::at_origin);
  for (std::size_t i = 0; i < 541; ++i) ASSERT_NEAR(spot.ranges[i], ideal.ranges[i], 2e-6f * ideal.ranges[i]) << i;
}

TEST(SpotScan, BeamsAcrossAnEdgeMixNearSurfacesAndTakeTheNearerOfFarOnes) {
  const std::size_t ahead = 270;
  // The box's edge runs through the spot's middle (a hair off, so that no ray meets the edge itself).
  const LaserScan near = Hall(wall_with_box(3.0f, 2.9f, 0.0005f)).scan(forward());
  EXPECT_GT(near.ranges[ahead], 2.92f);
  EXPECT_LT(near.ranges[ahead], 2.98f);
  const LaserScan far = Hall(wall_with_box(3.0f, 2.0f, 0.0005f)).scan(forward());
  EXPECT_NEAR(far.ranges[ahead], 2.0, 0.001);
  LaserConfig narrow = forward();
  narrow.spot.mixed = false;
  EXPECT_NEAR(Hall(wall_with_box(3.0f, 2.9f, 0.0005f)).scan(narrow).ranges[ahead], 3.0, 1e-4);
}

// At 2.9 m the spot is 8 mm + 15 mrad * 2.9 m = 51.5 mm wide; the outer looks stand at two thirds of its radius, 17 mm from the middle.
TEST(SpotScan, TheSpotWidensWithDistance) {
  const std::size_t ahead = 270;
  for (const double miss : {0.015, 0.019}) {
    const LaserScan scan = Hall(wall_with_box(3.0f, 2.9f, static_cast<float>(miss))).scan(forward());
    if (miss < 0.017) {
      EXPECT_LT(scan.ranges[ahead], 2.995f);
    } else {
      EXPECT_NEAR(scan.ranges[ahead], 3.0, 0.001);
    }
  }
}

TEST(SpotScan, DarkAndGrazingSurfacesDropOut) {
  // Nearly black at 4 m: 0.012 / 16 is less than the least signal; at 2 m it is three times as much.
  const auto ahead = [](float distance, bool dropouts) {
    Scene scene = fixtures::room(-1, distance, -4, 4, 3, {0.012f, 0.012f, 0.012f});
    scene.materials[0].reflectivity_850nm = 0.012f;
    LaserConfig config = forward();
    config.spot.dropouts = dropouts;
    return Hall(std::move(scene)).scan(config).ranges[270];
  };
  EXPECT_NEAR(ahead(2.0f, true), 2.0, 0.001);
  EXPECT_EQ(ahead(6.0f, true), 0.0f);
  EXPECT_NEAR(ahead(6.0f, false), 6.0, 0.002);
}

TEST(SpotScan, MaskedBeamsAreBlind) {
  const Hall hall(fixtures::room(-3, 5, -2, 4, 3));
  LaserConfig config = forward();
  config.spot.masked_deg = {-135.1, -90.1, 44.9, 60.1};
  const LaserScan scan = hall.scan(config);
  for (int i = 0; i < 541; ++i) {
    const double deg = -135.0 + 0.5 * i;
    EXPECT_EQ(scan.ranges[static_cast<std::size_t>(i)] == 0.0f, deg < -90.1 || (deg > 44.9 && deg < 60.1)) << deg;
  }
}

TEST(LaserPresets, HaveTheBeamsOfTheirDataSheets) {
  const LaserConfig tim = LaserConfig::make("sick_tim571"), utm = LaserConfig::make("hokuyo_utm30lx"),
                    s300 = LaserConfig::make("sick_s300");
  EXPECT_NEAR(to_degrees(s300.angle_increment()), 0.5, 1e-9);
  EXPECT_NEAR(to_degrees(tim.angle_increment()), 1.0 / 3.0, 1e-9);
  EXPECT_NEAR(to_degrees(utm.angle_increment()), 0.25, 1e-9);
  EXPECT_NEAR(to_seconds(s300.beam_interval()) * 720, 0.04, 1e-5);
}

}  // namespace
}  // namespace waretwin
