// Counter-based random streams (Random123, Philox 4x32-10; Salmon et al., SC 2011). A draw is a pure function of
// (seed, sensor, purpose, stamp, index, draw): nothing depends on the order of calls, on threads, or on what other sensors do.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/stamp.h"

namespace waretwin {

class RandomStream {
 public:
  // The purpose tells apart the draws of one sensor ("depth_noise", "dropout"). The stamp is that of the frame or scan; 0 for what is
  // drawn once per run.
  RandomStream(std::uint64_t seed, std::string_view sensor, std::string_view purpose, Stamp stamp = 0);

  // Four independent 32-bit words. `index` is the pixel or beam, `draw` counts what one pixel needs more than four words for.
  std::array<std::uint32_t, 4> words(std::uint64_t index, std::uint32_t draw = 0) const;

  // The words of `count` neighbouring indices from `first`, all at draw 0: out[i] == words(first + i). For whole images.
  void fill(std::uint64_t first, std::size_t count, std::array<std::uint32_t, 4>* out) const;

  // Uniform in [0, 1) with 53 random bits.
  double uniform(std::uint64_t index, std::uint32_t draw = 0) const;
  // Two independent uniforms in [0, 1) with 24 random bits each.
  std::array<float, 2> uniform_pair(std::uint64_t index, std::uint32_t draw = 0) const;
  // Standard normal (Box-Muller), and two independent ones at the price of one.
  double normal(std::uint64_t index, std::uint32_t draw = 0) const;
  std::array<float, 2> normal_pair(std::uint64_t index, std::uint32_t draw = 0) const;

 private:
  std::array<std::uint32_t, 2> key_;
};

// The generator itself: ten rounds of Philox 4x32.
std::array<std::uint32_t, 4> philox_words(const std::array<std::uint32_t, 4>& counter, const std::array<std::uint32_t, 2>& key);

// 64-bit hash of text (FNV-1a with a final mix); stable across machines and versions, keys of random streams rely on it.
std::uint64_t hash_text(std::string_view text);

}  // namespace waretwin
