#include "sensors/laser_noise.h"

#include <cmath>

#include "core/random.h"

namespace waretwin {

LaserNoiseModel::LaserNoiseModel(const LaserConfig& laser, std::uint64_t seed, const std::string& sensor)
    : laser_(laser), seed_(seed), sensor_(sensor) {
  if (laser.noise.enabled) bias_m_ = laser.noise.bias_max_m * (2.0 * RandomStream(seed, sensor, "range_bias").uniform(0) - 1.0);
}

void LaserNoiseModel::apply(LaserScan& scan) const {
  const RandomStream random(seed_, sensor_, "range_noise", scan.stamp);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    double range = scan.ranges[i];
    scan.ranges[i] = 0.0f;
    if (!(range > 0.0) || !std::isfinite(range)) continue;
    const double sigma = laser_.noise.enabled ? laser_.noise.deviation(range, laser_.range_max_m) : 0.0;
    range += bias_m_;
    if (sigma > 0.0) range += sigma * random.normal(i);
    if (laser_.range_step_m > 0.0) range = std::nearbyint(range / laser_.range_step_m) * laser_.range_step_m;
    // The step is not a binary number: a reading on the limit itself must count.
    constexpr double kSlack = 1e-9;
    if (range > 0.0 && range >= laser_.range_min_m - kSlack && range <= laser_.range_max_m + kSlack) {
      scan.ranges[i] = static_cast<float>(range);
    }
  }
}

}  // namespace waretwin
