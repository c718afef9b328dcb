// Where a sensor really sits on the vehicle.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"
#include "sensors/mount.h"

namespace waretwin {

// Draws the bracket's error and the vibration's phases from (seed, sensor); a pure function of time after that.
class MountError {
 public:
  MountError(const Mount& mount, std::uint64_t seed, const std::string& sensor);

  // It shakes; otherwise the poses are the same at any time and speed.
  bool shakes() const { return shakes_; }
  // As built and shaken, on a vehicle of this speed; the very poses of the mount where it has neither error. See Mount::X_BL, X_BC.
  Pose X_BL(Stamp stamp, double speed_mps) const { return exact_ ? mount_.X_BL() : mount_.X_BL() * error(stamp, speed_mps); }
  Pose X_BC(Stamp stamp, double speed_mps) const;

 private:
  struct Wave {
    double amplitude, radians_per_s, phase;
  };
  using Axes = std::array<double, 6>;  // x, y, z in metres, roll, pitch, yaw in radians
  // Of the forward frame L as it is, in that frame as drawn.
  Pose error(Stamp stamp, double speed_mps) const;

  Mount mount_;
  bool exact_ = true, shakes_ = false;
  Axes bracket_{};
  std::array<std::vector<Wave>, 6> waves_;
};

}  // namespace waretwin
