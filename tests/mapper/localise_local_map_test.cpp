#include "mapper/localise/local_map_localiser.h"

#include <gtest/gtest.h>

#include <ctime>

#include "core/error.h"
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

TEST(LocalMapLocaliser, StaysWithinMillimetresOnALap) {
  const test::PlanarDrive drive = hall_drive();
  LocalMapLocaliser localiser({}, drive.info());
  const std::clock_t start = std::clock();
  const Summary s = summary_of(drive, localiser, 48.0);
  std::cout << "lap: rms " << 1e3 * s.rms << " mm, worst " << 1e3 * s.worst << " mm, worst yaw " << s.worst_yaw_deg << " deg, keyframes "
            << localiser.counts().keyframes << "; CPU " << 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / localiser.counts().scans
            << " ms a scan with its simulation\n";
  EXPECT_EQ(localiser.counts().not_matched, 0);
  EXPECT_LT(s.rms, 0.003);
  EXPECT_LT(s.worst_yaw_deg, 0.3);
}

TEST(LocalMapLocaliser, FindsTheLasersConstantError) {
  for (const double bias : {-0.02, 0.012, 0.02}) {
    test::PlanarDrive drive = hall_drive(3);
    drive.bias = bias;
    LocalMapLocaliser localiser({}, drive.info());
    const Summary with = summary_of(drive, localiser, 24.0);
    LocalMapConfig off;
    off.estimate_bias = false;
    LocalMapLocaliser without_state(off, drive.info());
    const Summary without = summary_of(drive, without_state, 24.0);
    std::cout << "bias " << bias << ": found " << localiser.range_bias_m() << ", rms " << 1e3 * with.rms << " mm, without " << 1e3 * without.rms
              << " mm, steps " << localiser.counts().bias_steps << "\n";
    EXPECT_NEAR(localiser.range_bias_m(), bias, 0.003);
    EXPECT_LT(with.rms, 0.004);
  }
}

TEST(LocalMapLocaliser, ItsCovarianceIsThatOfItsErrors) {
  for (double b : {0.0, 0.015}) {
  double nees = 0.0; int count = 0; Eigen::Vector3d ratio = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    test::PlanarDrive drive = hall_drive(seed);
    drive.bias = b;
    LocalMapLocaliser localiser({}, drive.info());
    drive.run(localiser, 6.0, [&](double t) {
      if (std::fmod(t + 1e-6, 2.0) > 0.01 || t < 1) return;
      const Eigen::Vector3d e = drive.error_of(localiser, t);
      const Eigen::Matrix3d P = *localiser.covariance();
      nees += e.dot(P.inverse() * e);
      for (int i = 0; i < 3; ++i) ratio[i] += e[i] * e[i] / P(i, i);
      if (seed <= 3) std::cout << t << " err " << 1e3 * e.transpose() << " sd " << 1e3 * P.diagonal().cwiseSqrt().transpose() << "\n";
      ++count;
    });
  }
  std::cout << "bias " << b << " NEES / 3: " << nees / count / 3 << " per axis " << (ratio / count).transpose() << " of " << count << "\n";
  }
}

TEST(LocalMapLocaliser, TrustsOdometryAlongACorridor) {
  test::PlanarDrive drive;
  test::add_rectangle(drive.walls, -50, -1.1, 100, 1.1);
  drive.pose = [](double t) { return PlanarMotion{{0.8 * (t + std::exp(-t) - 1.0), 0.1 * std::sin(0.5 * t)}, 0.06 * std::cos(0.5 * t)}; };
  drive.error = kS300;
  drive.range_max = 12.0;
  drive.distance_scale = 1.02;
  LocalMapLocaliser localiser({}, drive.info());
  drive.run(localiser, 12.0, [&](double t) {
    const Eigen::Vector3d e = drive.error_of(localiser, t);
    const Eigen::Matrix3d P = *localiser.covariance();
    if (std::fmod(t + 1e-6, 2.0) < 0.01) std::cout << t << " x " << drive.pose(t).translation.x() << " err " << e.transpose() << " sd " << P.diagonal().cwiseSqrt().transpose() << "\n";
  });
  std::cout << "degenerate " << localiser.counts().degenerate << " of " << localiser.counts().scans << "\n";
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
  LocalMapLocaliser localiser({}, drive.info());
  double worst_late = 0.0;
  drive.run(localiser, 10.0, [&](double t) {
    const Eigen::Vector3d e = drive.error_of(localiser, t);
    if (t > 7.9 && t < 8.5) std::cout << t << " " << e.transpose() << " " << localiser.last_match().believable << localiser.last_match().matched_fraction << "\n";
    if (t > 9.0) worst_late = std::max(worst_late, e.head<2>().norm());
  });
  std::cout << "worst " << worst_late << " found " << localiser.counts().found_again << " lost " << localiser.counts().not_matched << "\n";
}

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
  // Round the block at 1 m/s with rounded corners (radius 0.6 about the block's corners at 1.2 m from it).
  drive.pose = [](double t) {
    const double w = 19.2, h = 11.2, r = 1.2, arc = 0.5 * std::numbers::pi * r, lap = 2 * (w + h) + 4 * arc;
    double s = std::fmod(0.9 * (t + std::exp(-t) - 1.0), lap);
    const double x0 = 2.4, y0 = 2.4;
    const double sides[4] = {w, h, w, h};
    const Eigen::Vector2d corner[4] = {{x0, y0}, {x0 + w, y0}, {x0 + w, y0 + h}, {x0, y0 + h}};
    for (int i = 0; i < 4; ++i) {
      const double heading = 0.5 * std::numbers::pi * i;
      const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), out(std::sin(heading), -std::cos(heading));
      if (s < sides[i]) return PlanarMotion{corner[i] + s * along + r * out, wrap_angle(heading)};
      s -= sides[i];
      if (s < arc) {
        const double turn = heading + s / r;
        return PlanarMotion{corner[(i + 1) % 4] + r * Eigen::Vector2d(std::sin(turn), -std::cos(turn)), wrap_angle(turn)};
      }
      s -= arc;
    }
    return PlanarMotion{corner[0] + r * Eigen::Vector2d(0, -1), 0.0};
  };
  drive.error = {0.02, 0.01};
  drive.range_max = 6.0;
  drive.scan_s = 0.2;
  drive.distance_scale = 1.02;
  for (const bool loops : {false, true}) {
    LocalMapConfig config;
    config.loops = loops;
    config.map_path_m = 15.0;
    LocalMapLocaliser localiser(config, drive.info());
    double worst = 0, late = 0;
    drive.run(localiser, 90.0, [&](double t) {
      const double e = drive.error_of(localiser, t).head<2>().norm();
      worst = std::max(worst, e);
      if (t > 80.0) late = std::max(late, e);
      if (std::fmod(t + 1e-6, 10.0) < 0.01) std::cout << t << " " << 1e3 * drive.error_of(localiser, t).transpose() << " sd " << 1e3 * localiser.covariance()->diagonal().cwiseSqrt().transpose() << "\n";
    });
    std::cout << "loops " << loops << ": worst " << worst << " late " << late << " closed " << localiser.counts().loops << " lost " << localiser.counts().not_matched << " degenerate " << localiser.counts().degenerate << "\n";
  }
}

}  // namespace
}  // namespace waretwin
