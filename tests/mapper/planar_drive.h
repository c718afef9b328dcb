// Drives through rooms of straight walls: what a laser and wheels on a vehicle measure along a path given in closed form.
#pragma once

#include <cmath>
#include <functional>
#include <optional>

#include "core/pose.h"
#include "mapper/localise/localiser.h"
#include "mapper/localise/odometry_history.h"
#include "sensors/sensor_stream.h"
#include "tests/mapper/planar_room.h"

namespace waretwin::test {

struct PlanarDrive {
  std::vector<Wall> walls;
  std::function<PlanarMotion(double)> pose;      // X_WB at a time in seconds
  std::function<PlanarMotion(double)> believed;  // what the wheels follow; empty: `pose`
  RangeError error;
  double bias = 0.0;  // metres, on every range
  double range_max = 30.0;
  double distance_scale = 1.0, turn_scale = 1.0;  // of the wheels
  double scan_s = 0.04;
  std::uint64_t seed = 1;
  Pose X_BL = make_upright_pose(0.275, 0.2, 0.3, to_radians(43.9));

  StreamInfo info() const {
    StreamInfo info;
    info.source = "room";
    info.lasers["laser"] = {X_BL, 1.0 / scan_s};
    info.has_odometry = true;
    info.X_WB_start = upright(pose(0.0));
    return info;
  }

  // 541 beams in 30 ms, each from where the laser is at its own instant.
  LaserScan scan(Stamp stamp) const {
    LaserScan scan;
    scan.stamp = stamp;
    scan.sensor = "laser";
    scan.angle_min = to_radians(-135);
    scan.angle_increment = to_radians(0.5);
    scan.beam_interval = from_seconds(0.04) / 720;
    scan.range_min = 0.05;
    scan.range_max = range_max;
    const RandomStream random(seed, "laser", "range", stamp);
    for (int i = 0; i < 541; ++i) {
      const PlanarMotion X_WL = pose(to_seconds(stamp + i * scan.beam_interval)) * planar(X_BL);
      const double range = cast(walls, X_WL.translation, X_WL.yaw + scan.angle_min + i * scan.angle_increment);
      scan.ranges.push_back(range < range_max ? static_cast<float>(error(range + bias, random, static_cast<std::uint64_t>(i))) : 0.0f);
    }
    return scan;
  }

  // Odometry every 20 ms, scans every scan_s, up to `end` seconds; calls `after` after each scan with its time.
  void run(Localiser& localiser, double end, const std::function<void(double)>& after = {}) const {
    const auto& wheels = believed ? believed : pose;
    PlanarMotion X_OB{{-3.0, 1.0}, 0.7};  // starts anywhere
    const RandomStream slip(seed, "wheels", "slip");
    const Stamp step = from_seconds(0.02), scan_step = from_seconds(scan_s);
    for (Stamp now = 0; now <= from_seconds(end); now += step) {
      if (now > 0) {
        const PlanarMotion moved = wheels(to_seconds(now - step)).inverse() * wheels(to_seconds(now));
        const double length = moved.translation.norm();
        const auto n = static_cast<std::uint64_t>(now / step);
        X_OB = X_OB * PlanarMotion{distance_scale * moved.translation, turn_scale * moved.yaw + 0.01 * std::sqrt(length) * slip.normal(n)};
      }
      localiser.add(OdometryReading{now, "wheels", upright(X_OB)});
      if (now % scan_step != 0) continue;
      localiser.add(scan(now));
      if (after) after(to_seconds(now));
    }
  }

  // x, y, yaw: how far the localiser's newest pose is off at time t.
  Eigen::Vector3d error_of(const Localiser& localiser, double t) const {
    const Pose X_WB = *localiser.current_pose();
    const PlanarMotion truth = pose(t);
    Eigen::Vector3d e;
    e << X_WB.translation().head<2>() - truth.translation, wrap_angle(yaw_of(X_WB) - truth.yaw);
    return e;
  }
};

// Out along the hall of planar_room.h and back in another lane: an ellipse of 8 x 1.6 m, heading along it, from rest, `lap` seconds a lap.
inline std::function<PlanarMotion(double)> ellipse(double lap) {
  return [lap](double t) {
    const double phase = 2 * std::numbers::pi * (t + std::exp(-t) - 1.0) / lap;
    return PlanarMotion{{6.0 - 4.0 * std::cos(phase), 3.2 - 0.8 * std::sin(phase)},
                        std::atan2(-0.8 * std::cos(phase), 4.0 * std::sin(phase))};
  };
}

}  // namespace waretwin::test
