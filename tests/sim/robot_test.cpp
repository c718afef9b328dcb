#include "sim/robot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/error.h"

namespace waretwin {
namespace {

Waypoint at(double x, double y, std::optional<double> heading_deg = {}, double wait_s = 0.0, bool reverse = false) {
  Waypoint waypoint;
  waypoint.x_m = x;
  waypoint.y_m = y;
  waypoint.heading_deg = heading_deg;
  waypoint.wait_s = wait_s;
  waypoint.reverse = reverse;
  return waypoint;
}

RobotConfig tour() {
  RobotConfig robot;
  robot.route = {at(1, 2, 90, 0.5), at(4, 2), at(4, 2.05, -170), at(6, -1, {}, 1.0, true), at(6, -1, 170), at(-2, 0)};
  return robot;
}

TEST(TrapezoidalProfile, ClosedForm) {
  const TrapezoidalProfile full(2.0, 0.5, 0.25);  // ramps of 2 s and 0.5 m, 2 s of cruising
  EXPECT_DOUBLE_EQ(full.duration(), 6.0);
  EXPECT_DOUBLE_EQ(full.position(2.0), 0.5);
  EXPECT_DOUBLE_EQ(full.position(3.0), 1.0);
  EXPECT_DOUBLE_EQ(full.velocity(3.0), 0.5);
  EXPECT_DOUBLE_EQ(full.position(6.0), 2.0);
  EXPECT_DOUBLE_EQ(full.position(99.0), 2.0);
  const TrapezoidalProfile brief(0.25, 10.0, 1.0);  // never reaches the speed
  EXPECT_DOUBLE_EQ(brief.duration(), 1.0);
  EXPECT_DOUBLE_EQ(brief.velocity(0.5), 0.5);
  EXPECT_DOUBLE_EQ(brief.position(0.5), 0.125);
}

TEST(RobotMotion, StandsAtItsWaypoints) {
  const RobotConfig robot = tour();
  const RobotMotion motion(robot);
  for (std::size_t i = 0; i < robot.route.size(); ++i) {
    const Pose X_WB = motion.X_WB(motion.arrival(i) + 1);
    EXPECT_NEAR(X_WB.translation().x(), robot.route[i].x_m, 1e-12);
    EXPECT_NEAR(X_WB.translation().y(), robot.route[i].y_m, 1e-12);
    if (robot.route[i].heading_deg) {
      EXPECT_NEAR(wrap_angle(yaw_of(X_WB) - to_radians(*robot.route[i].heading_deg)), 0.0, 1e-12);
    }
  }
  const Pose end = motion.X_WB(motion.duration() + from_seconds(100));
  EXPECT_NEAR(end.translation().x(), -2, 1e-12);
  EXPECT_NEAR(motion.distance_m(), 3 + 0.05 + std::hypot(2, 3.05) + std::hypot(8, 1), 1e-12);
  // The wait before leaving counts.
  EXPECT_TRUE(motion.X_WB(from_seconds(0.5)).isApprox(motion.X_WB(0)));
}

TEST(RobotMotion, KeepsItsLimitsAndTwistIsTheDerivative) {
  const RobotConfig robot = tour();
  const RobotMotion motion(robot);
  constexpr double kStep = 1e-3;
  const Stamp step = from_seconds(kStep);
  double speed_before = 0.0, turn_before = 0.0, top_speed = 0.0, top_turn = 0.0;
  bool reversed = false;
  for (Stamp t = 0; t < motion.duration() + 10 * step; t += step) {
    const Pose a = motion.X_WB(t), b = motion.X_WB(t + step);
    const Eigen::Vector3d moved_B = a.linear().transpose() * (b.translation() - a.translation());
    const double speed = moved_B.x() / kStep, turn = wrap_angle(yaw_of(b) - yaw_of(a)) / kStep;
    ASSERT_NEAR(moved_B.y(), 0.0, 1e-9);  // a differential drive never slides sideways
    ASSERT_LE(std::abs(speed), robot.speed_mps + 1e-9);
    ASSERT_LE(std::abs(turn), to_radians(robot.turn_rate_deg_s) + 1e-9);
    ASSERT_LE(std::abs(speed - speed_before) / kStep, robot.acceleration_mps2 * (1 + 1e-6) + 1e-6);
    ASSERT_LE(std::abs(turn - turn_before) / kStep, to_radians(robot.turn_acceleration_deg_s2) * (1 + 1e-6) + 1e-6);
    const Twist twist = motion.twist(t + step / 2);
    ASSERT_NEAR(twist.forward_mps, speed, robot.acceleration_mps2 * kStep);
    ASSERT_NEAR(twist.turn_rad_s, turn, to_radians(robot.turn_acceleration_deg_s2) * kStep);
    speed_before = speed;
    turn_before = turn;
    top_speed = std::max(top_speed, speed);
    top_turn = std::max(top_turn, std::abs(turn));
    reversed = reversed || speed < -0.1;
  }
  EXPECT_NEAR(top_speed, robot.speed_mps, 1e-9);
  EXPECT_NEAR(top_turn, to_radians(robot.turn_rate_deg_s), 1e-9);
  EXPECT_TRUE(reversed);
}

TEST(RobotMotion, LooksTowardsTheSecondWaypointWithoutAHeading) {
  RobotConfig robot;
  robot.route = {at(0, 0), at(-1, 1)};
  EXPECT_NEAR(yaw_of(RobotMotion(robot).X_WB(0)), to_radians(135), 1e-12);
}

TEST(RobotMotion, RejectsWhatCannotMove) {
  EXPECT_THROW(RobotMotion{RobotConfig{}}, Error);
  RobotConfig robot = tour();
  robot.speed_mps = 0;
  EXPECT_THROW(RobotMotion{robot}, Error);
}

}  // namespace
}  // namespace waretwin
