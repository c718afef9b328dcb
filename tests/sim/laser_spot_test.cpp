#include "sim/laser_spot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sensors/laser_noise.h"
#include "sim/laser_scanner.h"
#include "tests/sim/fixtures.h"
#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

using fixtures::add_instance;
using fixtures::add_material;
using fixtures::add_mesh;
using fixtures::placed;

struct Hall {
  std::shared_ptr<const RayCaster> caster;
  Surfaces surfaces;
  explicit Hall(Scene scene) : caster(fixtures::caster_of(std::move(scene))), surfaces(caster) {}
  // On a vehicle at the origin.
  LaserScan scan(const LaserConfig& config) const {
    return spot_scan(*caster, surfaces, config, "laser", 0, [&](Stamp) { return config.mount.X_BL(); });
  }
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
  const LaserScan spot = hall.scan(config),
                  ideal = ideal_scan(*hall.caster, config, "laser", 0, [&](Stamp) { return config.mount.X_BL(); });
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

// A marker on the wall straight ahead, seen by the whole spot.
TEST(SpotScan, RetroreflectorsReadShortByTheirSignal) {
  for (const char* preset : {"sick_s300", "sick_tim571", "hokuyo_utm30lx"}) {
    LaserConfig config = LaserConfig::make(preset);
    config.mount = {.z_m = 0.3};
    const auto ahead = static_cast<std::size_t>(config.beams / 2);
    double last = 1.0;
    for (const float wall : {1.0f, 3.0f, 5.0f, 10.0f, 20.0f}) {
      Scene scene = fixtures::room(-1, wall, -6, 6, 3);
      fixtures::add_marker(scene, {wall - 0.001f, -0.5f, 0.0f}, 1.0f, 220.0f);
      const Hall hall(std::move(scene));
      const double distance = wall - 0.001, signal = 220.0 / (distance * distance);
      const double share = std::clamp(std::log(signal / 0.1) / std::log(300.0), 0.0, 1.0);
      config.spot.retroreflectors = true;
      EXPECT_NEAR(hall.scan(config).ranges[ahead], distance - config.spot.retro_shift_m * share, 0.002) << preset << " " << wall;
      EXPECT_LE(share, last);
      last = share;
      config.spot.retroreflectors = false;
      EXPECT_NEAR(hall.scan(config).ranges[ahead], distance, 0.001) << preset << " " << wall;
    }
    EXPECT_GT(last, 0.2);
    EXPECT_LT(last, 0.6);
  }
  // The operating instructions' figure for the S300; the others keep to what their data sheets promise of any surface.
  EXPECT_EQ(LaserConfig::make("sick_s300").spot.retro_shift_m, 0.2);
  EXPECT_EQ(LaserConfig::make("sick_tim571").spot.retro_shift_m, 0.06);
  EXPECT_EQ(LaserConfig::make("hokuyo_utm30lx").spot.retro_shift_m, 0.03);
}

// Its edge runs through the middle of the spot: three of seven looks meet it (a hair off, as above).
TEST(SpotScan, HalfASpotOnARetroreflectorReadsLessShort) {
  Scene scene = fixtures::room(-1, 5, -6, 6, 3);
  fixtures::add_marker(scene, {4.999f, 0.0005f, 0.0f}, 1.0f, 220.0f);
  const double half = Hall(std::move(scene)).scan(forward()).ranges[270];
  EXPECT_NEAR(half, 4.999 - 0.2 * std::log(3.0 / 7.0 * 220.0 / 25.0 / 0.1) / std::log(300.0), 0.003);
}

// A sheet turned away by 60 deg sends back the 64th part; by 84 deg nothing, and what is dark or grazing stays unseen.
TEST(SpotScan, ObliqueRetroreflectorsReadLessShortOrNothing) {
  LaserConfig config = forward();
  Scene scene = fixtures::room(-20, 20, -20, 2, 3);
  const int material = add_material(scene, {0.05f, 0.05f, 0.05f});
  scene.materials.back().retroreflection = 220.0f;
  Mesh tape;  // along the wall on the left
  fixtures::add_quad(tape, {-20, 1.999f, 0}, {-20, 1.999f, 1}, {20, 1.999f, 1}, {20, 1.999f, 0});
  add_instance(scene, add_mesh(scene, tape, material));
  const Hall hall(std::move(scene));
  // Beams in steps of half a degree from -135 deg: 90 deg meets the wall straight on.
  const LaserScan scan = hall.scan(config);
  config.spot.retroreflectors = false;
  const LaserScan plain = hall.scan(config);
  const auto beam = [](double deg) { return static_cast<std::size_t>(std::lround(2.0 * (deg + 135.0))); };
  for (const double incidence : {0.0, 30.0, 60.0}) {
    const double cosine = std::cos(to_radians(incidence)), distance = 1.999 / cosine;
    const double signal = 220.0 * std::pow(cosine, 6) / (distance * distance);
    const double shift = 0.2 * std::clamp(std::log(signal / 0.1) / std::log(300.0), 0.0, 1.0);
    const std::size_t i = beam(90.0 - incidence);
    EXPECT_NEAR(plain.ranges[i] - scan.ranges[i], shift, 0.004) << incidence;
  }
  EXPECT_EQ(scan.ranges[beam(6.0)], 0.0f);
  EXPECT_EQ(plain.ranges[beam(6.0)], 0.0f);
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

// The width of a beam averages a wall over the spot. Head-on that is right to a millimetre; up to 60 deg it stays far below the systematic
// error of the product, and with the product's error on top a run keeps its limits: 200 runs, 95 % confidence for all of them together.
TEST(SpotScan, WidthDoesNotBiasAWall) {
  for (const float wall : {0.5f, 1.37f, 2.0f, 4.013f, 8.0f}) {
    const Hall hall(fixtures::room(-9, wall, -16, 16, 3));
    const LaserConfig config = forward();
    const LaserScan scan = hall.scan(config);
    for (int deg = -60; deg <= 60; ++deg) {
      const double expected = wall / std::cos(to_radians(deg));
      ASSERT_NEAR(scan.ranges[static_cast<std::size_t>(270 + 2 * deg)], expected, std::abs(deg) <= 10 ? 0.001 : 0.005)
          << wall << " " << deg;
    }
  }
  const double wall = 1.37;
  const LaserConfig config = forward();
  const LaserScan wide = Hall(fixtures::room(-9, static_cast<float>(wall), -16, 16, 3)).scan(config);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const LaserNoiseModel model(config, seed, "laser");
    std::vector<double> errors, squares;
    for (Stamp stamp = 0; stamp < 30; ++stamp) {
      LaserScan scan = wide;
      scan.stamp = stamp;
      model.apply(scan);
      for (int i = 270 - 88; i <= 270 + 88; ++i) {  // to 44 deg, 1.9 m
        errors.push_back(scan.ranges[static_cast<std::size_t>(i)] - wall / std::cos(to_radians(0.5 * (i - 270))));
        squares.push_back(errors.back() * errors.back());
      }
    }
    // One of 200 runs lies beyond 3.66 deviations of the mean by chance in 5 of 100 tests.
    const double slack = 3.66 * std::sqrt(test::sample_variance(errors) / static_cast<double>(errors.size()));
    EXPECT_LE(std::abs(test::sample_mean(errors)), 0.020 + slack + 0.001) << seed;
    EXPECT_NEAR(test::sample_mean(errors), model.bias_m(), slack + 0.001) << seed;
    EXPECT_LE(std::sqrt(test::sample_mean(squares)), 0.028) << seed;
  }
}

TEST(LaserPresets, HaveTheBeamsOfTheirDataSheets) {
  const LaserConfig tim = LaserConfig::make("sick_tim571"), utm = LaserConfig::make("hokuyo_utm30lx"),
                    s300 = LaserConfig::make("sick_s300");
  EXPECT_NEAR(to_degrees(s300.angle_increment()), 0.5, 1e-9);
  EXPECT_NEAR(to_degrees(tim.angle_increment()), 1.0 / 3.0, 1e-9);
  EXPECT_NEAR(to_degrees(utm.angle_increment()), 0.25, 1e-9);
  for (const LaserConfig* laser : {&tim, &utm, &s300}) EXPECT_EQ(laser->field_deg, 270.0);
  EXPECT_EQ(tim.rate_hz, 15.0);
  EXPECT_EQ(utm.rate_hz, 40.0);
  EXPECT_EQ((std::vector<double>{tim.range_min_m, tim.range_max_m, utm.range_min_m, utm.range_max_m}),
            (std::vector<double>{0.05, 25.0, 0.1, 30.0}));
  EXPECT_NEAR(to_seconds(s300.beam_interval()) * 720, 0.04, 1e-5);
}

}  // namespace
}  // namespace waretwin
