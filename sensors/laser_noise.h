// What a laser scanner makes of true ranges: a systematic error that stays for the run, a random one for each beam, the range and the
// output steps of the product (data sheet values in sensors/laser_config.h).
#pragma once

#include <cstdint>
#include <string>

#include "sensors/laser_config.h"
#include "sensors/measurements.h"

namespace waretwin {

class LaserNoiseModel {
 public:
  // `sensor` is the laser's name; it keys the random numbers. The systematic error is drawn here, from seed and sensor.
  LaserNoiseModel(const LaserConfig& laser, std::uint64_t seed, const std::string& sensor);

  // Turns true ranges (metres, 0 or not finite = nothing hit) into readings, in place: multiples of the output step in
  // [range_min, range_max], 0 where there is none. With noise switched off, limits and steps remain.
  void apply(LaserScan& scan) const;

  double bias_m() const { return bias_m_; }

 private:
  LaserConfig laser_;
  std::uint64_t seed_;
  std::string sensor_;
  double bias_m_ = 0.0;
};

}  // namespace waretwin
