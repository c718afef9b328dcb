// Cheap random numbers for pictures. Sensor noise comes from RandomStream itself; a picture needs millions of draws whose quality hardly
// matters, so one word of a RandomStream seeds a hash (PCG's output function, M. O'Neill 2014; Jarzynski and Olano, JCGT 2020).
#pragma once

#include <cstdint>

#include "core/random.h"

namespace waretwin {

class PixelRandom {
 public:
  PixelRandom(std::uint32_t seed, std::uint32_t pixel) : state_(hash(seed ^ hash(pixel))) {}

  float uniform() {  // [0, 1)
    state_ = state_ * 747796405u + 2891336453u;
    return static_cast<float>(output(state_) >> 8) * 0x1p-24f;
  }

 private:
  static std::uint32_t output(std::uint32_t state) {
    const std::uint32_t word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
  }
  static std::uint32_t hash(std::uint32_t v) { return output(v * 747796405u + 2891336453u); }

  std::uint32_t state_;
};

// The word that seeds the pictures of one frame for one purpose.
inline std::uint32_t picture_seed(const RandomStream& stream) { return stream.words(0)[0]; }

}  // namespace waretwin
