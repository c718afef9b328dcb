// The generator's draws: a stream for each purpose.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/dice.h"

namespace waretwin::generate {

class Dice : public waretwin::Dice {
 public:
  Dice(std::uint64_t seed, std::string_view purpose, int attempt = 0) : waretwin::Dice(RandomStream(seed, "generate", purpose, attempt)) {}
};

// To the millimetre, as one would measure it.
inline double to_mm(double metres) { return std::round(metres * 1000.0) / 1000.0; }

}  // namespace waretwin::generate
