// Standard normals by the image: many at once, the same on every CPU.
#pragma once

#include <cstddef>
#include <cstdint>

namespace waretwin {

// Words that one call turns into normals: small enough for the first-level cache.
constexpr std::size_t kNormalBlock = 512;

// out[i] = the standard normal of the random word words[i], exact in the tails to 1 / 2^33. count <= kNormalBlock.
void normals_of_words(const std::uint32_t* words, std::size_t count, float* out);

// The nearest whole number to x in [0, 2^22), ties to even, as std::nearbyint would give it.
inline float nearest_whole(float x) {
  constexpr float kShift = 12582912.0f;
  return (x + kShift) - kShift;
}

}  // namespace waretwin
