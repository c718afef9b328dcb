#include <gtest/gtest.h>

#include <ctime>

#include "core/error.h"
#include "mapper/localise/local_map_localiser.h"
#include "tests/mapper/planar_drive.h"
#include "tests/support/expect_error.h"

namespace waretwin {
namespace {

const test::RangeError kS300{0.008, 0.01};  // random part of the S300, output in steps of 10 mm

test::PlanarDrive hall_drive(std::uint64_t seed = 1, double lap = 48.0) {
  test::PlanarDrive drive;
  drive.walls = test::hall();
  drive.pose = test::ellipse(lap);
  drive.error = kS300;
  drive.distance_scale = 1.03;
  drive.turn_scale = 0.96;
  drive.seed = seed;
  return drive;
}

// Along corridors of 2.4 m around a block of 19.2 x 11.2 m, round its corners in arcs of 1.2 m, at 0.9 m/s from rest.
PlanarMotion round_the_block(double t) {
  const double w = 19.2, h = 11.2, r = 1.2, arc = 0.5 * std::numbers::pi * r, lap = 2 * (w + h) + 4 * arc;
  double s = std::fmod(0.9 * (t + std::exp(-t) - 1.0), lap);
  const double sides[4] = {w, h, w, h};
  const Eigen::Vector2d corners[4] = {{2.4, 2.4}, {2.4 + w, 2.4}, {2.4 + w, 2.4 + h}, {2.4, 2.4 + h}};
  for (int i = 0; i < 4; ++i) {
    const double heading = 0.5 * std::numbers::pi * i;
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), out(std::sin(heading), -std::cos(heading));
    if (s < sides[i]) return {corners[i] + s * along + r * out, wrap_angle(heading)};
    s -= sides[i];
    if (s < arc) {
      const double turn = heading + s / r;
      return {corners[(i + 1) % 4] + r * Eigen::Vector2d(std::sin(turn), -std::cos(turn)), wrap_angle(turn)};
    }
    s -= arc;
  }
  return {corners[0] + Eigen::Vector2d(0, -r), 0.0};
}

struct Summary {
  double rms = 0.0, worst = 0.0, worst_yaw_deg = 0.0;
};

Summary summary_of(const test::PlanarDrive& drive, LocalMapLocaliser& localiser, double end) {
  Summary summary;
  int count = 0;
  drive.run(localiser, end, [&](double t) {
    const Eigen::Vector3d e = drive.error_of(localiser, t);
    summary.rms += e.head<2>().squaredNorm();
    summary.worst = std::max(summary.worst, e.head<2>().norm());
    summary.worst_yaw_deg = std::max(summary.worst_yaw_deg, to_degrees(std::abs(e.z())));
    ++count;
  });
  summary.rms = std::sqrt(summary.rms / count);
  return summary;
}

TEST(LocalMapLocaliser, StaysWithinMillimetres) {
  const test::PlanarDrive drive = hall_drive();
  LocalMapLocaliser localiser({}, drive.info());
  const std::clock_t start = std::clock();
  const Summary s = summary_of(drive, localiser, 30.0);
  std::cout << "drive: rms " << 1e3 * s.rms << " mm, worst " << 1e3 * s.worst << " mm, worst yaw " << s.worst_yaw_deg << " deg, keyframes "
            << localiser.counts().keyframes << "; CPU "
            << 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / localiser.counts().scans
            << " ms a scan with its simulation\n";
  EXPECT_EQ(localiser.counts().not_matched, 0);
  EXPECT_LT(s.rms, 0.002);
  EXPECT_LT(s.worst_yaw_deg, 0.25);
}

TEST(LocalMapLocaliser, FindsTheLasersConstantError) {
  for (const double bias : {-0.02, 0.012}) {
    test::PlanarDrive drive = hall_drive(3);
    drive.bias = bias;
    LocalMapLocaliser localiser({}, drive.info());
    const Summary with = summary_of(drive, localiser, 20.0);
    LocalMapConfig off;
    off.estimate_bias = false;
    LocalMapLocaliser unaware(off, drive.info());
    const Summary without = summary_of(drive, unaware, 20.0);
    std::cout << "bias " << bias << ": found " << localiser.range_bias_m() << ", rms " << 1e3 * with.rms << " mm, without "
              << 1e3 * without.rms << " mm\n";
    EXPECT_NEAR(localiser.range_bias_m(), bias, 0.002);
    EXPECT_EQ(unaware.range_bias_m(), 0.0);
    EXPECT_LT(with.rms, 0.0025);
    EXPECT_LT(1.5 * with.rms, without.rms);
  }
}

// Errors over 12 drives, squared and divided by the covariance that was given for them: 1 a dimension on the mean, were all of it known.
TEST(LocalMapLocaliser, ItsCovarianceIsThatOfItsErrors) {
  double sum = 0.0;
  Eigen::Vector3d by_axis = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    test::PlanarDrive drive = hall_drive(seed);
    drive.bias = 0.01;
    LocalMapLocaliser localiser({}, drive.info());
    drive.run(localiser, 4.0, [&](double t) {
      if (t < 1.9 || (t > 2.1 && t < 3.9)) return;
      const Eigen::Vector3d e = drive.error_of(localiser, t);
      const Eigen::Matrix3d P = *localiser.covariance();
      sum += e.dot(P.inverse() * e) / 3.0;
      by_axis += (e.array().square() / P.diagonal().array()).matrix();
      ++count;
    });
  }
  std::cout << "normalised squared error a dimension " << sum / count << "; x, y, yaw: " << (by_axis / count).transpose() << "\n";
  EXPECT_GT(sum / count, 0.4);
  EXPECT_LT(sum / count, 1.8);
  EXPECT_GT((by_axis / count).minCoeff(), 0.2);
  EXPECT_LT((by_axis / count).maxCoeff(), 2.5);
}

TEST(LocalMapLocaliser, TrustsOdometryAlongACorridor) {
  test::PlanarDrive drive;
  test::add_rectangle(drive.walls, -50, -1.1, 100, 1.1);
  drive.pose = [](double t) { return PlanarMotion{{0.8 * (t + std::exp(-t) - 1.0), 0.1 * std::sin(0.5 * t)}, 0.06 * std::cos(0.5 * t)}; };
  drive.error = kS300;
  drive.range_max = 12.0;
  drive.distance_scale = 1.02;
  LocalMapLocaliser localiser({}, drive.info());
  const double end = 10.0;
  double worst_across = 0.0;
  drive.run(localiser, end, [&](double t) { worst_across = std::max(worst_across, std::abs(drive.error_of(localiser, t).y())); });
  EXPECT_GT(localiser.counts().degenerate, localiser.counts().scans - 5);
  EXPECT_EQ(localiser.counts().not_matched, 0);
  // Across and in heading the walls hold the vehicle, along it is off by what the wheels are off, and it says so.
  const double driven = drive.pose(end).translation.x();
  const Eigen::Vector3d e = drive.error_of(localiser, end);
  EXPECT_NEAR(e.x(), 0.02 * driven, 0.02);
  EXPECT_LT(worst_across, 0.005);
  EXPECT_LT(std::abs(to_degrees(e.z())), 0.15);
  const Eigen::Vector3d sd = localiser.covariance()->diagonal().cwiseSqrt();
  EXPECT_GT(sd.x(), 0.5 * std::abs(e.x()));
  EXPECT_LT(sd.x(), 0.1 * driven);
  EXPECT_LT(sd.y(), 0.01);

  // Told to use whatever the scans say, it believes in their noise, which stays where it is: the vehicle seems to be held.
  LocalMapConfig trusting;
  trusting.match.degeneracy = false;
  LocalMapLocaliser held(trusting, drive.info());
  drive.run(held, end);
  EXPECT_EQ(held.counts().degenerate, 0);
  EXPECT_LT(std::sqrt((*held.covariance())(0, 0)), 0.5 * sd.x()) << "the check above must be what keeps the covariance wide";
}

TEST(LocalMapLocaliser, IsFoundAgainAfterItWasCarriedAway) {
  test::PlanarDrive drive = hall_drive();
  drive.believed = drive.pose;
  const auto path = drive.pose;
  drive.pose = [path](double t) {
    PlanarMotion X = path(t);
    if (t > 8.0) X = X * PlanarMotion{{1.2, -0.5}, 0.8};
    return X;
  };
  for (const bool searching : {true, false}) {
    LocalMapConfig config;
    config.search.enabled = searching;
    LocalMapLocaliser localiser(config, drive.info());
    double worst = 0.0;
    drive.run(localiser, 10.0, [&](double t) {
      if (t > 8.5) worst = std::max(worst, drive.error_of(localiser, t).head<2>().norm());
    });
    if (searching) {
      EXPECT_GE(localiser.counts().found_again, 1);
      EXPECT_LT(localiser.counts().not_matched, 10);
      EXPECT_LT(worst, 0.02);
    } else {
      EXPECT_GT(worst, 0.5) << "this test must be a hard one";
    }
  }
}

TEST(LocalMapLocaliser, CarriesOnByOdometryWhereTheLaserIsBlind) {
  const test::PlanarDrive drive = hall_drive();
  LocalMapLocaliser localiser({}, drive.info());
  double sd_blind = 0.0;
  for (Stamp now = 0; now <= from_seconds(4.0); now += from_seconds(0.02)) {
    localiser.add(OdometryReading{now, "wheels", upright(drive.pose(to_seconds(now)))});
    if (now % from_seconds(0.04) != 0) continue;
    LaserScan scan = drive.scan(now);
    const bool blind = now > from_seconds(3.0) && now < from_seconds(3.5);
    if (blind) std::fill(scan.ranges.begin(), scan.ranges.end(), 0.0f);
    localiser.add(scan);
    if (blind) sd_blind = std::sqrt((*localiser.covariance())(0, 0));
    EXPECT_LT(drive.error_of(localiser, to_seconds(now)).head<2>().norm(), 0.03);
  }
  EXPECT_EQ(localiser.counts().not_matched, 12);
  EXPECT_GT(sd_blind, 3.0 * std::sqrt((*localiser.covariance())(0, 0)));
}

TEST(LocalMapLocaliser, NeedsNoOdometry) {
  const test::PlanarDrive drive = hall_drive();
  LocalMapLocaliser localiser({}, drive.info());
  double worst = 0.0;
  for (Stamp now = 0; now <= from_seconds(8.0); now += from_seconds(0.04)) {
    localiser.add(drive.scan(now));
    worst = std::max(worst, drive.error_of(localiser, to_seconds(now)).head<2>().norm());
  }
  EXPECT_EQ(localiser.counts().not_matched, 0);
  EXPECT_LT(worst, 0.015);
}

// Corridors around a block, with niches few and far between, walked once and a bit more: what has drifted on the way round is put right
// when the place of departure is seen again.
TEST(LocalMapLocaliser, StraightensALoop) {
  test::PlanarDrive drive;
  test::add_rectangle(drive.walls, 0, 0, 24, 16);
  test::add_rectangle(drive.walls, 2.4, 2.4, 21.6, 13.6);
  for (int i = 0; i < 5; ++i) {
    test::add_rectangle(drive.walls, 4.0 + 3.7 * i, 0.0, 4.3 + 3.7 * i, 0.25);
    test::add_rectangle(drive.walls, 3.1 + 4.1 * i, 15.7, 3.5 + 4.1 * i, 16.0);
  }
  for (int i = 0; i < 3; ++i) {
    test::add_rectangle(drive.walls, 0.0, 3.6 + 3.3 * i, 0.3, 3.9 + 3.3 * i);
    test::add_rectangle(drive.walls, 23.7, 4.1 + 3.9 * i, 24.0, 4.5 + 3.9 * i);
  }
  drive.pose = round_the_block;
  drive.error = {0.02, 0.01};
  drive.range_max = 6.0;
  drive.scan_s = 0.2;
  drive.distance_scale = 1.02;
  double at_the_end[2] = {0.0, 0.0};
  for (const bool loops : {false, true}) {
    LocalMapConfig config;
    config.loops = loops;
    config.map_path_m = 15.0;
    LocalMapLocaliser localiser(config, drive.info());
    drive.run(localiser, 79.0);
    at_the_end[loops ? 1 : 0] = drive.error_of(localiser, 79.0).head<2>().norm();
    EXPECT_EQ(localiser.counts().loops > 0, loops);
    EXPECT_EQ(localiser.counts().not_matched, 0);
  }
  std::cout << "after one round of 68 m: " << at_the_end[0] << " m off without loops, " << at_the_end[1] << " m with\n";
  EXPECT_GT(at_the_end[0], 0.05) << "there must be a drift to put right";
  EXPECT_LT(at_the_end[1], 0.02);
}

TEST(LocalMapLocaliser, GivesTheSameBitsEachTime) {
  const test::PlanarDrive drive = hall_drive();
  LocalMapLocaliser one({}, drive.info()), two({}, drive.info());
  drive.run(one, 4.0);
  drive.run(two, 4.0);
  EXPECT_EQ(one.current_pose()->matrix(), two.current_pose()->matrix());
  EXPECT_EQ(*one.covariance(), *two.covariance());
}

TEST(LocalMapLocaliser, ItsStartAndItsErrors) {
  StreamInfo info;
  info.source = "blind";
  EXPECT_ERROR(LocalMapLocaliser({}, info), "blind", "no laser");
  info = hall_drive().info();
  LocalMapLocaliser localiser({}, info);
  EXPECT_FALSE(localiser.current_pose());
  EXPECT_FALSE(localiser.covariance());
  RgbdFrame frame;
  EXPECT_EQ(localiser.pose_at(frame)->matrix(), info.X_WB_start.matrix());
  LaserScan empty;
  empty.sensor = "another";
  localiser.add(empty);
  EXPECT_FALSE(localiser.current_pose()) << "scans of other lasers are ignored";
  empty.sensor = "laser";
  localiser.add(empty);
  EXPECT_TRUE(localiser.current_pose()->matrix().allFinite());
}

}  // namespace
}  // namespace waretwin
