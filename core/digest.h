// A 64-bit fingerprint of results, equal exactly when the bytes are equal (for practical purposes). Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace waretwin {

class Digest {
 public:
  void add_bytes(const void* data, std::size_t size);
  void add(std::string_view text);
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) { add_bytes(&value, sizeof value); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(const std::vector<T>& values) { add_bytes(values.data(), values.size() * sizeof(T)); }

  std::uint64_t value() const;
  std::string hex() const;  // 16 lower-case digits

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
  std::uint64_t length_ = 0;
};

}  // namespace waretwin
