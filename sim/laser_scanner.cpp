#include "sim/laser_scanner.h"

#include <cmath>
#include <vector>

namespace waretwin {

LaserScan empty_scan(const LaserConfig& config, const std::string& sensor, Stamp stamp) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.sensor = sensor;
  // What a driver says of its scan are 32-bit floats (sensor_msgs/LaserScan): recordings of any kind then hold the very numbers.
  const auto as_float = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  scan.angle_min = as_float(config.angle_min());
  scan.angle_increment = as_float(config.angle_increment());
  scan.beam_interval = config.beam_interval();
  scan.range_min = as_float(config.range_min_m);
  scan.range_max = as_float(config.range_max_m);
  scan.ranges.assign(static_cast<std::size_t>(config.beams), 0.0f);
  return scan;
}

LaserScan ideal_scan(const RayCaster& ray_caster, const LaserConfig& config, const std::string& sensor, Stamp stamp,
                     const std::function<Pose(Stamp)>& X_WL_at) {
  LaserScan scan = empty_scan(config, sensor, stamp);
  const auto beams = static_cast<std::size_t>(config.beams);
  std::vector<Ray> rays(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const Stamp moment = stamp + static_cast<Stamp>(i) * scan.beam_interval;
    const Pose X_WL = X_WL_at(moment);
    rays[i].time = ray_caster.time_of(moment);
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    rays[i].origin = X_WL.translation().cast<float>();
    rays[i].direction = (X_WL.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)).cast<float>();
    // Light that meets a surface nearer than the first measurable range is lost, so rays start at the scanner.
    rays[i].far = static_cast<float>(config.range_max_m);
  }
  std::vector<Hit> hits(beams);
  ray_caster.cast(rays, hits, Coherence::kCoherent);
  for (std::size_t i = 0; i < beams; ++i) {
    if (hits[i].valid() && hits[i].distance >= static_cast<float>(config.range_min_m)) scan.ranges[i] = hits[i].distance;
  }
  return scan;
}

}  // namespace waretwin
