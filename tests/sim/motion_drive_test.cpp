// The vehicle on wheels: it follows its route, slips as declared, skids where it must, and says what it touched.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "sim/motion/hall_motion.h"
#include "sim/robot.h"
#include "tests/sim/motion_scene.h"

namespace waretwin {
namespace {

using fixtures::MotionScene;

Waypoint at(double x, double y) {
  Waypoint waypoint;
  waypoint.x_m = x;
  waypoint.y_m = y;
  return waypoint;
}

// A vehicle that drives `length` straight along x from the origin.
MotionScene straight(double length) {
  MotionScene hall;
  hall.scenario.robot.drive.model = "wheels";
  hall.scenario.robot.route = {at(0, 0), at(length, 0)};
  return hall;
}

// By how much more than it drove, as a share, the wheels turned between two times on the way along x.
double slip_between(HallMotion& motion, double from_s, double to_s) {
  const auto places = [&motion](double time_s) {
    const Stamp at = from_seconds(time_s);
    motion.advance_to(at);
    return std::pair(motion.wheels_X_WB(at).translation().x(), motion.X_WB(at).translation().x());
  };
  const auto [reckoned_from, from] = places(from_s);
  const auto [reckoned_to, to] = places(to_s);
  const double reckoned = reckoned_to - reckoned_from;
  return (reckoned - (to - from)) / reckoned;
}

TEST(Drive, FollowsItsRouteWithinACentimetre) {
  MotionScene hall;
  hall.scenario.robot.drive.model = "wheels";
  Waypoint turn = at(2, 0);
  turn.heading_deg = 90;
  Waypoint back = at(2, 1);
  back.reverse = true;
  hall.scenario.robot.route = {at(0, 0), turn, at(2, 2), back, at(-1, 0)};
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  const RobotMotion plan(hall.scenario.robot);
  motion.advance_to(motion.duration() + kNanosecondsPerSecond);
  double farthest = 0.0, most_turned = 0.0, most_tilted = 0.0;
  for (Stamp t = 0; t <= motion.duration() + kNanosecondsPerSecond; t += 20'000'000) {
    const Pose is = motion.X_WB(t), planned = plan.X_WB(t);
    farthest = std::max(farthest, (is.translation() - planned.translation()).head<2>().norm());
    most_turned = std::max(most_turned, std::abs(wrap_angle(yaw_of(is) - yaw_of(planned))));
    most_tilted = std::max(most_tilted, std::acos(std::min(1.0, is.linear()(2, 2))));
    EXPECT_NEAR(is.translation().z(), 0.0, 0.003);
  }
  EXPECT_LT(farthest, 0.01);
  EXPECT_LT(most_turned, to_radians(0.6));
  EXPECT_GT(farthest, 1e-5) << "wheels are not rails";
  EXPECT_LT(most_tilted, to_radians(0.3));
  EXPECT_GT(most_tilted, 1e-5) << "it dives when it brakes";
  EXPECT_TRUE(motion.report().contacts.empty());
}

TEST(Drive, StandsLevelAndDipsByItsAcceleration) {
  MotionScene hall = straight(6.0);
  RobotConfig& robot = hall.scenario.robot;
  robot.acceleration_mps2 = 0.5;
  robot.speed_mps = 10.0;
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  motion.advance_to(from_seconds(2.0));
  const auto pitch = [&](Stamp at) { return std::asin(-motion.X_WB(at).linear()(2, 0)); };
  EXPECT_NEAR(pitch(0), 0.0, 1e-7);
  EXPECT_NEAR(motion.X_WB(0).translation().z(), 0.0, 1e-6);
  // The traction pulls below the centre of mass; four springs at half the lever's length hold against it.
  const double lever = 0.5 * 0.85 * robot.length_m;
  const double stiffness = robot.drive.caster_share * robot.drive.mass_kg * 9.81 / 0.002;
  const double tilt = robot.drive.mass_kg * robot.acceleration_mps2 * 0.5 * robot.height_m / (stiffness * lever * lever);
  EXPECT_NEAR(pitch(from_seconds(1.8)), -tilt, 0.1 * tilt) << "its nose rises";
}

TEST(Drive, WheelsSlipByTractionOverStiffness) {
  // Speeding up evenly for the whole way, so that the traction is constant: T = m a, shared by both wheels, whose load is the weight less
  // what the casters carry.
  MotionScene hall = straight(6.0);
  RobotConfig& robot = hall.scenario.robot;
  robot.acceleration_mps2 = 0.4;
  robot.speed_mps = 10.0;
  robot.drive.tyre_stiffness_n_m = 1e9;
  for (const double stiffness : {8.0, 30.0}) {
    robot.drive.creep_stiffness = stiffness;
    const auto caster = hall.caster();
    HallMotion motion(hall.scenario, *caster);
    const double slip = robot.acceleration_mps2 / 9.81 / (1.0 - robot.drive.caster_share) / stiffness;
    EXPECT_NEAR(slip_between(motion, 1.0, 3.5), slip, 0.05 * slip) << "stiffness " << stiffness;
  }
}

TEST(Drive, ALoadFlattensItsTyres) {
  MotionScene hall = straight(8.0);
  DriveConfig& drive = hall.scenario.robot.drive;
  drive.payload_kg = 50.0;
  drive.payload_z_m = 0.2;
  drive.creep_stiffness = 1e4;
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  // The wheels are rigid against the sprung casters, so they take the whole load, half each.
  const double flattened = 0.5 * drive.payload_kg * 9.81 / drive.tyre_stiffness_n_m / drive.wheel_radius_m;
  EXPECT_NEAR(slip_between(motion, 3.0, 12.0), flattened, 0.1 * flattened);
  EXPECT_GT(flattened, 0.01);
}

TEST(Drive, ALoadOnOneSideDrawsACurveThatItsWheelsDoNotSee) {
  MotionScene hall = straight(8.0);
  DriveConfig& drive = hall.scenario.robot.drive;
  drive.payload_kg = 30.0;
  drive.payload_y_m = 0.15;
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  motion.advance_to(motion.duration());
  // The driver holds the line; the wheels think that they turned to the right, against the lower left side.
  EXPECT_NEAR(motion.X_WB(motion.duration()).translation().y(), 0.0, 0.03);
  EXPECT_GT(std::abs(yaw_of(motion.wheels_X_WB(motion.duration()))), 0.05);
}

TEST(Drive, SkidsOnIce) {
  MotionScene hall = straight(6.0);
  RobotConfig& robot = hall.scenario.robot;
  robot.acceleration_mps2 = 2.0;
  robot.drive.floor_friction = 0.05;
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  const Stamp when = from_seconds(0.4);
  motion.advance_to(when);
  // Friction on the wheels' share of the weight is all that moves it: s = mu g (1 - casters) t^2 / 2.
  const double reach = 0.5 * 0.05 * 9.81 * (1.0 - robot.drive.caster_share) * 0.4 * 0.4;
  EXPECT_NEAR(motion.X_WB(when).translation().x(), reach, 0.15 * reach);
  EXPECT_GT(motion.wheels_X_WB(when).translation().x(), 3.0 * reach);
}

TEST(Drive, ReportsWhatItTouches) {
  MotionScene hall = straight(3.0);
  hall.add_box({1.5f, -0.3f, 0.0f}, {0.3f, 0.6f, 0.5f});
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  motion.advance_to(motion.duration());
  const MotionReport report = motion.report();
  ASSERT_EQ(report.contacts.size(), 1u);
  // Its nose is 0.45 m before its middle.
  const RobotMotion plan(hall.scenario.robot);
  double expected = 0.0;
  while (plan.X_WB(from_seconds(expected)).translation().x() < 1.05) expected += 0.01;
  EXPECT_NEAR(to_seconds(report.contacts[0].begin), expected, 0.1);
  EXPECT_NEAR(report.contacts[0].p_W.x(), 1.5, 0.02);
  EXPECT_GT(report.contacts[0].force_n, 10.0);
  EXPECT_LT(motion.X_WB(motion.duration()).translation().x(), 1.07) << "the box stands";
}

// More parts than Bullet's tree can tell apart: it once read beyond its arrays.
TEST(Drive, ReportsWhatItTouchesAmongThousandsOfParts) {
  MotionScene hall = straight(3.0);
  for (int i = 0; i < 2500; ++i) {
    hall.add_box({-20.0f + 0.3f * static_cast<float>(i % 50), 10.0f + 0.3f * static_cast<float>(i / 50), 0.0f}, {0.1f, 0.1f, 0.5f});
  }
  hall.add_box({1.5f, -0.3f, 0.0f}, {0.3f, 0.6f, 0.5f}, -1, 0.0f, "the box in the way");
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  motion.advance_to(motion.duration());
  const MotionReport report = motion.report();
  ASSERT_EQ(report.contacts.size(), 1u);
  EXPECT_EQ(report.contacts[0].with, "the box in the way");
  EXPECT_LT(motion.X_WB(motion.duration()).translation().x(), 1.07) << "the box stands";
}

TEST(Drive, ExactFollowsItsPlanToTheBit) {
  MotionScene hall = straight(3.0);
  hall.scenario.robot.drive.model = "exact";
  const auto caster = hall.caster();
  HallMotion motion(hall.scenario, *caster);
  const RobotMotion plan(hall.scenario.robot);
  motion.advance_to(from_seconds(2.0));
  EXPECT_EQ(motion.X_WB(from_seconds(1.3)).matrix(), plan.X_WB(from_seconds(1.3)).matrix());
  EXPECT_EQ(motion.wheels_X_WB(from_seconds(1.3)).matrix(), plan.X_WB(from_seconds(1.3)).matrix());
}

TEST(Drive, TheSameHoweverTheAskingIsDivided) {
  const MotionScene hall = straight(2.0);
  const auto caster_a = hall.caster(), caster_b = hall.caster();
  HallMotion a(hall.scenario, *caster_a), b(hall.scenario, *caster_b);
  a.advance_to(from_seconds(4.0));
  for (int i = 1; i <= 40; ++i) b.advance_to(from_seconds(0.1 * i));
  EXPECT_EQ(a.digest(), b.digest());
  EXPECT_EQ(a.X_WB(from_seconds(1.234567)).matrix(), b.X_WB(from_seconds(1.234567)).matrix());
}

}  // namespace
}  // namespace waretwin
