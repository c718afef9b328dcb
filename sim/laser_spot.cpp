#include "sim/laser_spot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sim/infrared.h"
#include "sim/laser_scanner.h"

namespace waretwin {

namespace {

constexpr std::size_t kLooks = 7;
constexpr double kRing = 2.0 / 3.0;  // of the spot's radius

struct Echo {
  float range = 0.0f, strength = 0.0f;
  float retroreflected = 0.0f;  // part of the strength
};

// The range that a receiver reads from the echoes of one beam.
float range_of(std::array<Echo, kLooks>& echoes, const LaserSpot& spot) {
  std::sort(echoes.begin(), echoes.end(), [](const Echo& a, const Echo& b) { return a.range < b.range; });
  const float enough = spot.dropouts ? static_cast<float>(spot.min_signal) : 0.0f;
  for (std::size_t first = 0; first < kLooks;) {
    float strength = 0.0f, sum = 0.0f, retroreflected = 0.0f;
    std::size_t last = first;
    for (; last < kLooks && echoes[last].range <= echoes[first].range + static_cast<float>(spot.merge_m); ++last) {
      strength += echoes[last].strength;
      sum += echoes[last].strength * echoes[last].range;
      retroreflected += echoes[last].retroreflected;
    }
    if (strength > 0.0f && strength >= enough * static_cast<float>(kLooks)) {
      return sum / strength - static_cast<float>(spot.retro_shift(retroreflected / static_cast<float>(kLooks)));
    }
    first = last;
  }
  return 0.0f;
}

}  // namespace

LaserScan spot_scan(const RayCaster& ray_caster, const Surfaces& surfaces, const LaserConfig& config, const std::string& sensor,
                    Stamp stamp, const std::function<Pose(Stamp)>& X_WL_at) {
  const LaserSpot& spot = config.spot;
  LaserScan scan = empty_scan(config, sensor, stamp);
  const auto beams = static_cast<std::size_t>(config.beams);
  std::vector<Ray> rays(beams * kLooks);
  for (std::size_t i = 0; i < beams; ++i) {
    const Stamp moment = stamp + static_cast<Stamp>(i) * scan.beam_interval;
    const Pose X_WL = X_WL_at(moment);
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0.0), left(-std::sin(angle), std::cos(angle), 0.0);
    for (std::size_t k = 0; k < kLooks; ++k) {
      Eigen::Vector3d offset = Eigen::Vector3d::Zero();
      if (k > 0 && spot.mixed) {
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(k - 1) / (kLooks - 1);
        offset = kRing * (std::cos(turn) * left + std::sin(turn) * Eigen::Vector3d::UnitZ());
      }
      Ray& ray = rays[i * kLooks + k];
      ray.time = ray_caster.time_of(moment);
      ray.origin = (X_WL * (0.5 * spot.diameter_m * offset)).cast<float>();
      ray.direction = (X_WL.linear() * (along + 0.5 * spot.divergence_rad * offset).normalized()).cast<float>();
      ray.far = static_cast<float>(config.range_max_m);
    }
  }
  std::vector<Hit> hits(rays.size());
  ray_caster.cast(rays, hits, Coherence::kCoherent);
  std::array<Echo, kLooks> echoes;
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    if (spot.masks(angle)) continue;
    for (std::size_t k = 0; k < kLooks; ++k) {
      const Hit& hit = hits[i * kLooks + k];
      echoes[k] = {std::numeric_limits<float>::infinity(), 0.0f, 0.0f};
      if (!hit.valid()) continue;
      const Ray& ray = rays[i * kLooks + k];
      const SurfacePoint point = surfaces.at(ray, hit, static_cast<float>(spot.divergence_rad));
      const InfraredAnswer answer = infrared_answer(surfaces.material(hit), point, -ray.direction);
      const float square = hit.distance * hit.distance;
      echoes[k] = {hit.distance, answer.backscatter / square, answer.retroreflected / square};
    }
    const float range = range_of(echoes, spot);
    if (range >= static_cast<float>(config.range_min_m)) scan.ranges[i] = range;
  }
  return scan;
}

}  // namespace waretwin
