#include "sensors/mount_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace waretwin {

namespace {

constexpr int kWaves = 12;  // enough that their sum is about normal

}  // namespace

MountError::MountError(const Mount& mount, std::uint64_t seed, const std::string& sensor) : mount_(mount) {
  const RandomStream bracket(seed, sensor, "bracket"), vibration(seed, sensor, "vibration");
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const bool turns = axis >= 3;
    const double sigma = turns ? to_radians(mount.bracket.angle_sigma_deg) : mount.bracket.position_sigma_m;
    if (sigma > 0.0) {
      bracket_[axis] = sigma * bracket.normal(axis);
      exact_ = false;
    }
    const double rms = turns ? to_radians(mount.vibration.angle_rms_deg) : mount.vibration.position_rms_m;
    if (!(rms > 0.0)) continue;
    exact_ = false;
    shakes_ = true;
    for (int k = 0; k < kWaves; ++k) {
      const std::uint64_t draw = 2 * (axis * kWaves + static_cast<std::uint64_t>(k));
      // One from each part of the band, so that no draw leaves half of it empty.
      const double share = 0.5 + (k + vibration.uniform(draw)) / kWaves;
      waves_[axis].push_back({rms * std::sqrt(2.0 / kWaves), 2.0 * std::numbers::pi * share * mount.vibration.frequency_hz,
                              2.0 * std::numbers::pi * vibration.uniform(draw + 1)});
    }
  }
}

Pose MountError::error(Stamp stamp, double speed_mps) const {
  Axes axes = bracket_;
  const double share = std::clamp(std::abs(speed_mps) / mount_.vibration.full_speed_mps, 0.0, 1.0), t = to_seconds(stamp);
  for (std::size_t axis = 0; axis < 6 && share > 0.0; ++axis) {
    for (const Wave& wave : waves_[axis]) axes[axis] += share * wave.amplitude * std::sin(wave.radians_per_s * t + wave.phase);
  }
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(axes[0], axes[1], axes[2]);
  X.linear() = rotation_from_rpy(axes[3], axes[4], axes[5]);
  return X;
}

Pose MountError::X_BC(Stamp stamp, double speed_mps) const {
  if (exact_) return mount_.X_BC();
  Pose X = X_BL(stamp, speed_mps);
  X.linear() = X.linear() * optical_from_forward();
  return X;
}

}  // namespace waretwin
