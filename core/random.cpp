#include "core/random.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace waretwin {

namespace {

// Finaliser of SplitMix64: every input bit reaches every output bit.
std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

std::uint64_t combine(std::uint64_t seed, std::uint64_t value) { return mix(seed + 0x9e3779b97f4a7c15ULL + mix(value)); }

// (0, 1]: the logarithm of Box-Muller must never see 0.
double open_unit(std::uint32_t word) { return (static_cast<double>(word) + 1.0) * 0x1p-32; }
double unit(std::uint32_t word) { return static_cast<double>(word) * 0x1p-32; }

}  // namespace

std::uint64_t hash_text(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return mix(hash);
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view sensor, std::string_view purpose, Stamp stamp) {
  std::uint64_t key = combine(seed, hash_text(sensor));
  key = combine(key, hash_text(purpose));
  key = combine(key, static_cast<std::uint64_t>(stamp));
  key_[0] = static_cast<std::uint32_t>(key);
  key_[1] = static_cast<std::uint32_t>(key >> 32);
}

std::array<std::uint32_t, 4> philox_words(const std::array<std::uint32_t, 4>& counter, const std::array<std::uint32_t, 2>& key) {
  const r123::Philox4x32::ctr_type in = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type with = {{key[0], key[1]}};
  const r123::Philox4x32::ctr_type out = r123::Philox4x32()(in, with);
  return {out[0], out[1], out[2], out[3]};
}

std::array<std::uint32_t, 4> RandomStream::words(std::uint64_t index, std::uint32_t draw) const {
  return philox_words({static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), draw, 0}, key_);
}

void RandomStream::fill(std::uint64_t first, std::size_t count, std::array<std::uint32_t, 4>* out) const {
  for (std::size_t i = 0; i < count; ++i) out[i] = words(first + i);
}

double RandomStream::uniform(std::uint64_t index, std::uint32_t draw) const {
  const auto w = words(index, draw);
  const std::uint64_t bits = (static_cast<std::uint64_t>(w[0]) << 32 | w[1]) >> 11;
  return static_cast<double>(bits) * 0x1p-53;
}

std::array<float, 2> RandomStream::uniform_pair(std::uint64_t index, std::uint32_t draw) const {
  const auto w = words(index, draw);
  // 24 bits, so that rounding to float never yields 1.
  return {static_cast<float>(w[0] >> 8) * 0x1p-24f, static_cast<float>(w[1] >> 8) * 0x1p-24f};
}

double RandomStream::normal(std::uint64_t index, std::uint32_t draw) const {
  const auto w = words(index, draw);
  return std::sqrt(-2.0 * std::log(open_unit(w[0]))) * std::cos(2.0 * std::numbers::pi * unit(w[1]));
}

std::array<float, 2> RandomStream::normal_pair(std::uint64_t index, std::uint32_t draw) const {
  const auto w = words(index, draw);
  const double radius = std::sqrt(-2.0 * std::log(open_unit(w[0])));
  const double angle = 2.0 * std::numbers::pi * unit(w[1]);
  return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))};
}

}  // namespace waretwin
