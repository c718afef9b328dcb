// Random draws one after the other: what a generator wants from a counter-based stream (core/random.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/random.h"

namespace waretwin::generate {

// The same seed, purpose and attempt give the same draws; other purposes are left alone by more or fewer draws of this one.
class Dice {
 public:
  Dice(std::uint64_t seed, std::string_view purpose, int attempt = 0) : stream_(seed, "generate", purpose, attempt) {}

  double unit() { return stream_.uniform(next_++); }  // in [0, 1)
  double between(double low, double high) { return low + (high - low) * unit(); }
  int whole(int low, int high) { return std::min(high, low + static_cast<int>(unit() * (high - low + 1))); }  // ends included
  bool chance(double share) { return unit() < share; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  template <class T>
  const T& pick(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(whole(0, static_cast<int>(choices.size()) - 1))];
  }

 private:
  RandomStream stream_;
  std::uint64_t next_ = 0;
};

// To the millimetre, as one would measure it.
inline double to_mm(double metres) { return std::round(metres * 1000.0) / 1000.0; }

}  // namespace waretwin::generate
