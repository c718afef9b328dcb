#include <gtest/gtest.h>

#include <ctime>

#include "core/error.h"
#include "core/pose.h"
#include "mapper/localise/laser_icp_localiser.h"
#include "mapper/localise/simple_localisers.h"
#include "tests/mapper/planar_room.h"

namespace waretwin {
namespace {

constexpr Stamp kMs = 1'000'000;
constexpr double kLap = 48.0;  // seconds

// Out along the hall and back in another lane: an ellipse of 8 x 1.6 m about (6, 3), heading along it; sharp turns at the ends. It starts
// from rest,
// as the first scan has only one odometry reading before it.
PlanarMotion true_pose(double t) {
  const double phase = 2 * std::numbers::pi * (t + std::exp(-t) - 1.0) / kLap;
  return {{6.0 - 4.0 * std::cos(phase), 3.2 - 0.8 * std::sin(phase)}, std::atan2(-0.8 * std::cos(phase), 4.0 * std::sin(phase))};
}

const Pose kX_BL = make_upright_pose(0.275, 0.2, 0.3, to_radians(43.9));

StreamInfo stream_info() {
  StreamInfo info;
  info.source = "hall";
  info.lasers["laser"] = {kX_BL, 25.0};
  info.has_odometry = true;
  info.X_WB_start = upright(true_pose(0.0));
  return info;
}

// A scan of 541 beams in 30 ms of a 40 ms turn, each beam from where the laser is at its own instant.
LaserScan moving_scan(const std::vector<test::Wall>& walls, Stamp stamp, const test::RangeError& error) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.sensor = "laser";
  scan.angle_min = to_radians(-135);
  scan.angle_increment = to_radians(0.5);
  scan.beam_interval = 40 * kMs / 720;
  scan.range_min = 0.05;
  scan.range_max = 30.0;
  const RandomStream random(11, "laser", "range", stamp);
  for (int i = 0; i < 541; ++i) {
    const PlanarMotion X_WL = true_pose(to_seconds(stamp + i * scan.beam_interval)) * planar(kX_BL);
    const double range = test::cast(walls, X_WL.translation, X_WL.yaw + scan.angle_min + i * scan.angle_increment);
    scan.ranges.push_back(static_cast<float>(error(range, random, i)));
  }
  return scan;
}

// Wheels that measure 3 % too far and turn 4 % short.
struct Wheels {
  PlanarMotion X_OB{{-3.0, 1.0}, 0.7};  // starts anywhere
  double last = 0.0;
  OdometryReading reading(Stamp stamp) {
    const double t = to_seconds(stamp);
    const PlanarMotion step = true_pose(last).inverse() * true_pose(t);
    X_OB = X_OB * PlanarMotion{1.03 * step.translation, 0.96 * step.yaw};
    last = t;
    return {stamp, "wheels", upright(X_OB)};
  }
};

struct Errors {
  double rms = 0.0, worst = 0.0, worst_yaw_deg = 0.0;
  int count = 0;
  void add(const Pose& X_WB, const PlanarMotion& truth) {
    const double off = (X_WB.translation().head<2>() - truth.translation).norm();
    rms = std::sqrt((rms * rms * count + off * off) / (count + 1));
    ++count;
    worst = std::max(worst, off);
    worst_yaw_deg = std::max(worst_yaw_deg, to_degrees(angle_distance(yaw_of(X_WB), truth.yaw, 2 * std::numbers::pi)));
  }
};

// Drives a lap: odometry at 50 Hz, scans at 25 Hz, frames at 15 Hz in the order of their stamps.
Errors drive(Localiser& localiser, const test::RangeError& error, bool odometry = true, Errors* at_scans = nullptr) {
  const std::vector<test::Wall> walls = test::hall();
  Wheels wheels;
  Errors errors;
  Stamp next_frame = 5 * kMs;
  for (Stamp now = 0; now < from_seconds(kLap); now += 20 * kMs) {
    while (next_frame < now) {
      RgbdFrame frame;
      frame.stamp = next_frame;
      if (const auto X_WB = localiser.pose_at(frame)) errors.add(*X_WB, true_pose(to_seconds(next_frame)));
      next_frame += 66 * kMs + 666'667;
    }
    if (odometry) localiser.add(wheels.reading(now));
    if (now % (40 * kMs) == 0) {
      localiser.add(moving_scan(walls, now, error));
      if (at_scans) at_scans->add(*localiser.current_pose(), true_pose(to_seconds(now)));
    }
  }
  return errors;
}

TEST(LaserIcpLocaliser, FollowsADriveThroughANoiseFreeHall) {
  LaserIcpLocaliser localiser({}, stream_info());
  Errors at_scans;
  const Errors errors = drive(localiser, {}, true, &at_scans);
  std::cout << "noise-free lap: rms " << 1e3 * errors.rms << " mm, worst " << 1e3 * errors.worst << " mm, worst yaw "
            << errors.worst_yaw_deg << " deg\n";
  EXPECT_LT(errors.rms, 0.004);
  EXPECT_LT(errors.worst_yaw_deg, 0.3);
  // The trajectory's poses belong to the scans' own stamps.
  EXPECT_LT(at_scans.rms, 0.004);
  EXPECT_EQ(localiser.counts().not_matched, 0);
  EXPECT_GT(localiser.counts().keyframes, 10);
}

TEST(LaserIcpLocaliser, StaysWithinCentimetresUnderSensorNoiseAndDriftingWheels) {
  LaserIcpLocaliser localiser({}, stream_info());
  const std::clock_t start = std::clock();
  const Errors errors = drive(localiser, {0.02, 0.01});
  std::cout << "noisy lap: rms " << 1e3 * errors.rms << " mm, worst " << 1e3 * errors.worst << " mm, worst yaw " << errors.worst_yaw_deg
            << " deg; keyframes " << localiser.counts().keyframes << ", reused " << localiser.counts().keyframes_reused << "; CPU "
            << 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / localiser.counts().scans
            << " ms a scan with its simulation\n";
  EXPECT_EQ(localiser.counts().not_matched, 0);
  EXPECT_LT(errors.rms, 0.015);
  EXPECT_LT(errors.worst_yaw_deg, 0.6);

  OdometryLocaliser wheels(stream_info());
  const Errors drifting = drive(wheels, {0.02, 0.01});
  EXPECT_GT(drifting.rms, 10 * errors.rms) << "the laser must be what holds the pose";
}

TEST(LaserIcpLocaliser, NeedsNoOdometry) {
  LaserIcpLocaliser localiser({}, stream_info());
  const Errors errors = drive(localiser, {0.02, 0.01}, false);
  EXPECT_LT(errors.rms, 0.02);
}

TEST(LaserIcpLocaliser, CarriesOnByOdometryWhereTheLaserIsBlind) {
  LaserIcpLocaliser localiser({}, stream_info());
  const std::vector<test::Wall> walls = test::hall();
  Wheels wheels;
  for (Stamp now = 0; now <= from_seconds(4.0); now += 20 * kMs) {
    localiser.add(wheels.reading(now));
    if (now % (40 * kMs) != 0) continue;
    LaserScan scan = moving_scan(walls, now, {});
    if (now > from_seconds(3.0) && now < from_seconds(3.5)) std::fill(scan.ranges.begin(), scan.ranges.end(), 0.0f);
    localiser.add(scan);
    EXPECT_LT((localiser.current_pose()->translation().head<2>() - true_pose(to_seconds(now)).translation).norm(), 0.02);
  }
  EXPECT_EQ(localiser.counts().not_matched, 12);
}

TEST(LaserIcpLocaliser, StartsWhereTheStreamSays) {
  LaserIcpLocaliser localiser({}, stream_info());
  RgbdFrame frame;
  EXPECT_TRUE(localiser.pose_at(frame)->isApprox(stream_info().X_WB_start));
  EXPECT_FALSE(localiser.current_pose());
  StreamInfo blind = stream_info();
  blind.lasers.clear();
  EXPECT_THROW(LaserIcpLocaliser({}, blind), Error);
}

TEST(OdometryHistory, InterpolatesAndCarriesOnAlongTheArc) {
  OdometryHistory history;
  // A circle of radius 2 m at 1 rad/s.
  const auto on_circle = [](double t) { return PlanarMotion{{2 * std::sin(t), 2 - 2 * std::cos(t)}, t}; };
  for (int i = 0; i <= 50; ++i) history.add(i * 20 * kMs, on_circle(0.02 * i));
  for (const double t : {0.0, 0.013, 0.5, 0.999, 1.05, 1.2, -0.1}) {
    const PlanarMotion found = history.at(from_seconds(t));
    EXPECT_LT((found.translation - on_circle(t).translation).norm(), 1e-9) << t;
    EXPECT_NEAR(found.yaw, on_circle(t).yaw, 1e-9) << t;
  }
  EXPECT_NEAR(history.between(from_seconds(0.2), from_seconds(0.7)).yaw, 0.5, 1e-9);
  // Not for ever: after half a second of silence the vehicle is held.
  EXPECT_NEAR(history.at(from_seconds(60)).yaw, 1.5, 1e-9);
  EXPECT_THROW(history.add(0, {}), Error);
}

TEST(RecordedLocaliser, TakesThePoseThatCameWithTheFrame) {
  StreamInfo info;
  info.has_recorded_poses = true;
  info.cameras["camera"].X_BC = make_upright_pose(0.1, 0.0, 1.4, 0.3);
  RecordedLocaliser localiser(info);
  RgbdFrame frame;
  frame.sensor = "camera";
  EXPECT_FALSE(localiser.pose_at(frame));
  const Pose X_WB = make_upright_pose(3, 4, 0, 1.0);
  frame.recorded_X_WC = X_WB * info.cameras["camera"].X_BC;
  EXPECT_TRUE(localiser.pose_at(frame)->isApprox(X_WB));
  EXPECT_TRUE(localiser.current_pose()->isApprox(X_WB));
  frame.sensor = "other";
  EXPECT_THROW(localiser.pose_at(frame), Error);
  info.has_recorded_poses = false;
  EXPECT_THROW(RecordedLocaliser{info}, Error);
  EXPECT_THROW(OdometryLocaliser{info}, Error);
}

}  // namespace
}  // namespace waretwin
