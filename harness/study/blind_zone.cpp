#include "harness/study/blind_zone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/view_points.h"

namespace waretwin {

namespace {

// Whether the laser, standing on the vehicle, looks at this point of its plane.
bool looks_at(const LaserConfig& laser, const RayCaster* own_body, const Eigen::Vector2d& p_B) {
  const Pose X_BL = laser.mount.X_BL();
  Eigen::Vector3d towards = X_BL.linear().transpose() * (Eigen::Vector3d(p_B.x(), p_B.y(), laser.mount.z_m) - X_BL.translation());
  const double distance = towards.norm(), angle = std::atan2(towards.y(), towards.x());
  if (distance > laser.range_max_m || std::abs(angle) > 0.5 * to_radians(laser.field_deg) || laser.spot.masks(angle)) return false;
  if (own_body == nullptr) return true;
  // In the laser's own plane, which may be tilted.
  towards.z() = 0.0;
  Ray ray;
  ray.origin = X_BL.translation().cast<float>();
  ray.direction = (X_BL.linear() * towards).cast<float>();
  ray.far = 1.0f;
  return !own_body->occluded(ray);
}

}  // namespace

BlindZone blind_zone(const RobotConfig& robot, const SensorsConfig& sensors, const RayCaster* own_body, double radius_m) {
  BlindZone zone;
  const double half_length = 0.5 * robot.length_m, half_width = 0.5 * robot.width_m;
  std::vector<SurfaceSample> samples;
  const auto steps = [&](double reach) { return static_cast<int>(std::ceil(reach / zone.spacing_m)); };
  for (int iy = -steps(half_width + radius_m); iy <= steps(half_width + radius_m); ++iy) {
    for (int ix = -steps(half_length + radius_m); ix <= steps(half_length + radius_m); ++ix) {
      const double x = ix * zone.spacing_m, y = iy * zone.spacing_m;
      const double away = std::hypot(std::max(0.0, std::abs(x) - half_length), std::max(0.0, std::abs(y) - half_width));
      if (away <= 0.0 || away > radius_m) continue;
      samples.push_back({{static_cast<float>(x), static_cast<float>(y), 0.0f}, Eigen::Vector3f::UnitZ(), true, false});
    }
  }
  const VehicleInView body{own_body, Pose::Identity()};
  for (const auto& [name, camera] : sensors.cameras) {
    for (const std::size_t i : seen_in_frame(nullptr, samples, camera, camera.mount.X_BC(), body)) samples[i].seen = true;
  }
  // By distance ahead: how much of the lane is seen.
  std::map<int, std::pair<int, int>> lane;
  for (const SurfaceSample& sample : samples) {
    (sample.seen ? zone.seen : zone.unseen).emplace_back(sample.p_W.head<2>());
    const double x = static_cast<double>(sample.p_W.x()), y = static_cast<double>(sample.p_W.y());
    if (x <= half_length || std::abs(y) > half_width) continue;
    auto& [seen, all] = lane[static_cast<int>(std::lround(x / zone.spacing_m))];
    seen += sample.seen ? 1 : 0;
    ++all;
  }
  zone.floor_share = samples.empty() ? 0.0 : static_cast<double>(zone.unseen.size()) / static_cast<double>(samples.size());
  for (const auto& [step, share] : lane) {
    if (2 * share.first < share.second) continue;
    zone.ahead_m = step * zone.spacing_m - half_length;
    break;
  }
  constexpr int kDirections = 360;
  const double reach = std::hypot(half_length, half_width) + radius_m;
  int unseen = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDirections;
    const Eigen::Vector2d p_B(reach * std::cos(angle), reach * std::sin(angle));
    const bool seen =
        std::any_of(sensors.lasers.begin(), sensors.lasers.end(), [&](const auto& laser) { return looks_at(laser.second, own_body, p_B); });
    unseen += seen ? 0 : 1;
  }
  zone.laser_share = static_cast<double>(unseen) / kDirections;
  return zone;
}

}  // namespace waretwin
