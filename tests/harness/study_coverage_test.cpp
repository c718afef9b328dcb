// Coverage and blind zones against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/study/blind_zone.h"
#include "harness/study/coverage.h"
#include "tests/sim/fixtures.h"

namespace waretwin {
namespace {

// A camera whose depth fills a rectangle of 60 x 40 deg about its axis, from 0.1 to 20 m.
CameraConfig plain_camera(double height, double pitch_deg) {
  CameraConfig camera;
  camera.horizontal_fov_deg = 120;
  camera.vertical_fov_deg = 100;
  camera.field = {.horizontal_deg = 60, .vertical_deg = 40, .tilt_down_deg = 0, .shape = "rectangle"};
  camera.depth_min_m = 0.1;
  camera.depth_max_m = 20;
  camera.mount = {.z_m = height, .pitch_deg = pitch_deg};
  return camera;
}

SensorsConfig with_camera(const CameraConfig& camera) {
  SensorsConfig sensors;
  sensors.cameras["camera"] = camera;
  return sensors;
}

double tangent(double degrees) { return std::tan(to_radians(degrees)); }

TEST(BlindZone, OfARectangularFieldIsItsTrapezium) {
  const RobotConfig robot;
  constexpr double kHeight = 1.4, kPitch = 45.0, kRadius = 3.0;
  const BlindZone zone = blind_zone(robot, with_camera(plain_camera(kHeight, kPitch)), nullptr, kRadius);
  // The lower edge of the field meets the floor at h / tan(pitch + 20 deg).
  const double near = kHeight / tangent(kPitch + 20);
  ASSERT_TRUE(zone.ahead_m);
  EXPECT_NEAR(*zone.ahead_m, near - 0.5 * robot.length_m, zone.spacing_m);
  // Every point by itself.
  for (const bool seen : {true, false}) {
    for (const Eigen::Vector2f& p : seen ? zone.seen : zone.unseen) {
      const auto x = static_cast<double>(p.x()), y = static_cast<double>(p.y());
      const double down = std::atan2(kHeight, x);
      const double z = std::hypot(kHeight, x) * std::cos(down - to_radians(kPitch));
      const double up_share = std::abs(std::tan(down - to_radians(kPitch))) / tangent(20), side_share = std::abs(y) / z / tangent(30);
      if (std::abs(up_share - 1) < 1e-3 || std::abs(side_share - 1) < 1e-3) continue;
      EXPECT_EQ(seen, x > 0 && up_share < 1 && side_share < 1) << x << ", " << y;
    }
  }
  EXPECT_NEAR(zone.floor_share, static_cast<double>(zone.unseen.size()) / static_cast<double>(zone.unseen.size() + zone.seen.size()),
              1e-12);
  EXPECT_DOUBLE_EQ(zone.laser_share, 1.0);  // there is none
}

TEST(BlindZone, TheVehicleStandsInItsOwnWay) {
  // A board of 0.4 m height across the vehicle's front, as wide as it.
  Scene board;
  fixtures::add_instance(board, fixtures::add_mesh(board, fixtures::unit_box(), fixtures::add_material(board, {0.5f, 0.5f, 0.5f})),
                         fixtures::placed({0.44f, -5.0f, 0.0f}, {0.01f, 10.0f, 0.4f}));
  const RayCaster body(std::make_shared<const Scene>(board));
  const BlindZone zone = blind_zone(RobotConfig(), with_camera(plain_camera(1.4, 45)), &body, 3.0);
  // Over the board's edge: the line from (0, 1.4) through (0.45, 0.4) meets the floor at 0.45 * 1.4 / 1.0, nearer than the field's edge
  // would be only if the field reached there.
  const double shadow = 0.45 * 1.4 / (1.4 - 0.4), field = 1.4 / tangent(65);
  EXPECT_NEAR(*zone.ahead_m, std::max(shadow, field) - 0.45, 0.05);
  const BlindZone steep = blind_zone(RobotConfig(), with_camera(plain_camera(1.4, 70)), &body, 3.0);
  EXPECT_NEAR(*steep.ahead_m, shadow - 0.45, 0.05);  // a field that reaches to below the camera
}

TEST(BlindZone, OfALaserIsWhatItsFieldLeavesOut) {
  SensorsConfig sensors;
  sensors.lasers["laser"] = LaserConfig::make("ideal");
  sensors.lasers["laser"].mount = {.z_m = 0.3};
  EXPECT_NEAR(blind_zone(RobotConfig(), sensors, nullptr, 2.0).laser_share, 0.25, 2.0 / 360);
  sensors.lasers["laser"].spot.masked_deg = {-45, 0};
  EXPECT_NEAR(blind_zone(RobotConfig(), sensors, nullptr, 2.0).laser_share, 0.375, 3.0 / 360);
  sensors.lasers["behind"] = sensors.lasers["laser"];
  sensors.lasers["behind"].mount.yaw_deg = 180;
  // Left over: 135 to 180 deg, where the one behind is masked, and -45 to 0, where the one in front is.
  EXPECT_NEAR(blind_zone(RobotConfig(), sensors, nullptr, 2.0).laser_share, 0.25, 3.0 / 360);
}

// A vehicle that stands in the middle of a bare floor and looks straight down.
TEST(Coverage, LookingStraightDownSeesARectangle) {
  Scene scene = fixtures::room(-4, 4, -4, 4, 4);
  const auto hall = std::make_shared<const RayCaster>(std::make_shared<const Scene>(scene));
  Scenario scenario;
  scenario.sensors = with_camera(plain_camera(2.0, 90));
  scenario.robot.route = {Waypoint()};
  CoverageConfig config;
  config.floor_spacing_m = 0.05;
  config.reach_m = 20;
  const CoverageHall coverage(hall, scenario.robot, config);
  FloorLooks looks;
  const Coverage seen = coverage.along_route(scenario, nullptr, &looks);
  const double width = 2 * 2.0 * tangent(30), height = 2 * 2.0 * tangent(20);
  EXPECT_NEAR(seen.floor, width * height / 64.0, 0.01);
  EXPECT_TRUE(seen.objects.empty());
  std::size_t looked_at = 0;
  for (const int count : looks) looked_at += count > 0 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(looked_at) / static_cast<double>(looks.size()), seen.floor, 1e-9);  // all of the bare floor is viewable
}

// A room with a cube of 1 m on the floor, its corner of least x at (x, 1).
std::shared_ptr<const RayCaster> room_with_cube(float x) {
  Scene scene = fixtures::room(-6, 6, -4, 4, 4);
  const int object = fixtures::add_object(scene, "box");
  const int box = fixtures::add_mesh(scene, fixtures::unit_box(), fixtures::add_material(scene, {0.5f, 0.5f, 0.5f}));
  fixtures::add_instance(scene, box, fixtures::placed({x, 1.0f, 0.0f}, {1.0f, 1.0f, 1.0f}), object);
  return std::make_shared<const RayCaster>(std::make_shared<const Scene>(scene));
}

// From x = -3 to 3 along y, the camera 0.5 m high and to the left.
Scenario past_the_cube(double y) {
  Scenario scenario;
  CameraConfig camera = plain_camera(0.5, 0);
  camera.mount.yaw_deg = 90;
  scenario.sensors = with_camera(camera);
  Waypoint from, to;
  from.x_m = -3;
  to.x_m = 3;
  from.y_m = to.y_m = y;
  scenario.robot.route = {from, to};
  return scenario;
}

TEST(Coverage, ObjectsAreSeenFromTheSidesThatTheRoutePasses) {
  const auto hall = room_with_cube(-0.5f);
  Scenario scenario = past_the_cube(-1.5);
  const CoverageHall coverage(hall, scenario.robot, {});
  // Three sides of five that can be seen (the one below lies on the floor): the one that it passes, and in passing those to the left and
  // right of it; from 0.5 m height the top is out of sight.
  EXPECT_NEAR(coverage.along_route(scenario, nullptr).objects.at(0), 0.6, 0.02);
  scenario.sensors.cameras.at("camera").mount.yaw_deg = -90;
  EXPECT_DOUBLE_EQ(coverage.along_route(scenario, nullptr).objects.at(0), 0.0);
}

TEST(Coverage, BestMomentIsWhereObjectsAreSeen) {
  const auto hall = room_with_cube(2.5f);
  const Scenario scenario = past_the_cube(-1);
  EXPECT_GT(CoverageHall(hall, scenario.robot, {}).best_moment(scenario), 0.75);
}

}  // namespace
}  // namespace waretwin
