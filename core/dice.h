// Random draws one after the other: what a generator wants from a counter-based stream.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"

namespace waretwin {

// The same stream gives the same draws; other streams are left alone by more or fewer draws of this one.
class Dice {
 public:
  explicit Dice(const RandomStream& stream) : stream_(stream) {}

  double unit() { return stream_.uniform(next_++); }  // in [0, 1)
  double between(double low, double high) { return low + (high - low) * unit(); }
  int whole(int low, int high) { return std::min(high, low + static_cast<int>(unit() * (high - low + 1))); }  // ends included
  bool chance(double share) { return unit() < share; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  double normal() { return stream_.normal(next_++); }  // mean 0, standard deviation 1
  // A factor around 1: as often half as twice as much for stops = 1, at most.
  double stops(double stops) { return std::exp2(between(-stops, stops)); }
  template <class T>
  const T& pick(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(whole(0, static_cast<int>(choices.size()) - 1))];
  }

 private:
  RandomStream stream_;
  std::uint64_t next_ = 0;
};

}  // namespace waretwin
