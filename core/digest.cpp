#include "core/digest.h"

#include <cstdio>
#include <cstring>

namespace waretwin {

namespace {

std::uint64_t absorb(std::uint64_t state, std::uint64_t word) {
  state ^= word;
  state *= 0x9e3779b97f4a7c15ULL;
  return state ^ (state >> 29);
}

}  // namespace

void Digest::add_bytes(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes + i, 8);
    state_ = absorb(state_, word);
  }
  if (i < size) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, size - i);
    state_ = absorb(state_, word);
  }
  // The size keeps "ab" + "c" apart from "a" + "bc".
  state_ = absorb(state_, size);
  length_ += size;
}

void Digest::add(std::string_view text) { add_bytes(text.data(), text.size()); }

std::uint64_t Digest::value() const {
  std::uint64_t x = absorb(state_, length_);
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  return x ^ (x >> 32);
}

std::string Digest::hex() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value()));
  return text;
}

}  // namespace waretwin
