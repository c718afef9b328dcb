// Brackets and vibration as statistics.
#include "sensors/mount_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waretwin {
namespace {

Mount drawn() { return {.x_m = 0.1, .y_m = -0.2, .z_m = 1.4, .yaw_deg = 20, .pitch_deg = 45}; }

TEST(MountError, NoneIsTheMountToTheBit) {
  const MountError error(drawn(), 7, "camera");
  EXPECT_FALSE(error.shakes());
  EXPECT_EQ(error.X_BL(123, 1.0).matrix(), drawn().X_BL().matrix());
  EXPECT_EQ(error.X_BC(123, 1.0).matrix(), drawn().X_BC().matrix());
}

TEST(MountError, TheBracketIsDrawnOncePerSeedAndSensor) {
  Mount mount = drawn();
  mount.bracket = {.position_sigma_m = 0.01, .angle_sigma_deg = 0.5};
  const MountError error(mount, 7, "camera");
  EXPECT_FALSE(error.shakes());
  EXPECT_EQ(error.X_BL(0, 0.0).matrix(), error.X_BL(1'000'000'000, 0.5).matrix());
  EXPECT_NE(error.X_BL(0, 0.0).matrix(), MountError(mount, 8, "camera").X_BL(0, 0.0).matrix());
  EXPECT_NE(error.X_BL(0, 0.0).matrix(), MountError(mount, 7, "other").X_BL(0, 0.0).matrix());
  // The camera's axes are those of the forward frame turned, whatever the error.
  const Pose X_LC = error.X_BL(0, 0.0).inverse() * error.X_BC(0, 0.0);
  EXPECT_TRUE(X_LC.isApprox(drawn().X_BL().inverse() * drawn().X_BC(), 1e-12));

  constexpr int kSeeds = 2000;
  double position = 0.0, angle = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Pose X = drawn().X_BL().inverse() * MountError(mount, static_cast<std::uint64_t>(seed), "camera").X_BL(0, 0.0);
    position += X.translation().squaredNorm() / 3;
    angle += std::pow(Eigen::AngleAxisd(X.linear()).angle(), 2) / 3;
  }
  // The relative error of a variance from 3 n draws is sqrt(2 / 3n); four of those.
  const double slack = 4 * std::sqrt(2.0 / (3 * kSeeds));
  EXPECT_NEAR(position / kSeeds / 1e-4, 1.0, slack);
  EXPECT_NEAR(angle / kSeeds / std::pow(to_radians(0.5), 2), 1.0, slack + 1e-3);
}

TEST(MountError, VibrationHasItsRootMeanSquareAndBand) {
  Mount mount = drawn();
  mount.vibration = {.position_rms_m = 0.002, .angle_rms_deg = 0.0, .frequency_hz = 10, .full_speed_mps = 0.5};
  const MountError error(mount, 3, "camera");
  ASSERT_TRUE(error.shakes());
  EXPECT_TRUE(error.X_BL(5'000'000'000, 0.0).isApprox(drawn().X_BL(), 1e-15));  // standing
  const auto x_at = [&](double t, double speed) {
    return (drawn().X_BL().inverse() * error.X_BL(from_seconds(t), speed)).translation().x();
  };
  EXPECT_NEAR(x_at(3.3, 0.25), 0.5 * x_at(3.3, 0.5), 1e-12);
  EXPECT_NEAR(x_at(3.3, 2.0), x_at(3.3, 0.5), 1e-15);
  constexpr int kSamples = 40000;
  constexpr double kStep = 0.005;
  double square = 0.0;
  int crossings = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = x_at(i * kStep, 0.5);
    square += x * x / kSamples;
    if (i > 0 && (x > 0) != (x_at((i - 1) * kStep, 0.5) > 0)) ++crossings;
  }
  EXPECT_NEAR(std::sqrt(square), 0.002, 0.0001);
  // Crossings of zero a second are twice the root mean square frequency of the band, 5 to 15 Hz evenly: 10.4 (Rice).
  EXPECT_NEAR(crossings / (2 * kSamples * kStep), std::sqrt((15.0 * 15 * 15 - 5 * 5 * 5) / (3 * 10)), 0.6);
}

}  // namespace
}  // namespace waretwin
