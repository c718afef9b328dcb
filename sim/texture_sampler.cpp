#include "sim/texture_sampler.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"

namespace waretwin {

namespace {

std::array<float, 256> make_decode_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double s = i / 255.0;
    table[static_cast<std::size_t>(i)] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return table;
}

const std::array<float, 256>& decode_table() {
  static const std::array<float, 256> table = make_decode_table();
  return table;
}

// What each stored value is read as, 65535 = 1.
std::array<std::uint16_t, 256> sixteen_bits(TextureSampler::Encoding encoding) {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float value = encoding == TextureSampler::Encoding::kSrgb ? decode_table()[i] : static_cast<float>(i) / 255.0f;
    table[i] = static_cast<std::uint16_t>(std::lround(65535.0f * value));
  }
  return table;
}

// The texel that stands for the i-th along a side, for wrapping that is not kRepeat.
int wrapped(int i, int size, Texture::Wrap wrap) {
  if (i >= 0 && i < size) return i;
  if (wrap == Texture::Wrap::kClampToEdge) return std::clamp(i, 0, size - 1);
  int m = i % (2 * size);
  if (m < 0) m += 2 * size;
  return m < size ? m : 2 * size - 1 - m;
}

// Texel coordinate of u * size, kept where an int can hold it whatever the file says.
float bounded(float texel) { return std::isfinite(texel) ? std::clamp(texel, -1e8f, 1e8f) : 0.0f; }

// std::floor is a call into the library on the oldest CPUs that we build for. |x| <= 1e8.
int whole_below(float x) {
  const int i = static_cast<int>(x);
  return static_cast<float>(i) > x ? i - 1 : i;
}

// Of a positive, normal number or infinity: floor(log2(x)), which the library takes many steps for.
int exponent(float x) { return static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23) - 127; }

// The two texels around a coordinate along one side of a texture, and how far towards the second it is.
struct Taps {
  int first, second;
  float share;
};

// Inlined: two ints that a call returns are written one by one and read as eight bytes, which wait for the memory.
[[gnu::always_inline]] inline Taps taps(float coordinate, int size, Texture::Wrap wrap, bool nearest) {
  float c = bounded(coordinate);
  const bool repeats = wrap == Texture::Wrap::kRepeat;
  // Into [0, 1], so that nothing has to be divided below.
  if (repeats) c -= static_cast<float>(whole_below(c));
  const float texel = bounded(c * static_cast<float>(size)) - (nearest ? 0.0f : 0.5f);
  const int i = whole_below(texel);
  const auto within = [&](int k) {
    if (!repeats) return wrapped(k, size, wrap);
    return k < 0 ? k + size : k >= size ? k - size : k;
  };
  if (nearest) return {within(i), within(i), 0.0f};
  return {within(i), within(i + 1), texel - static_cast<float>(i)};
}

}  // namespace

float linear_from_srgb(std::uint8_t value) { return decode_table()[value]; }

float sample_alpha(const Texture& texture, const Eigen::Vector2f& uv) {
  const Taps tx = taps(uv.x(), texture.width, texture.wrap_u, texture.nearest);
  const Taps ty = taps(uv.y(), texture.height, texture.wrap_v, texture.nearest);
  const auto alpha = [&](int x, int y) {
    return static_cast<float>(
        texture.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(x)) + 3]);
  };
  const auto row = [&](int y) { return alpha(tx.first, y) + tx.share * (alpha(tx.second, y) - alpha(tx.first, y)); };
  return (row(ty.first) + ty.share * (row(ty.second) - row(ty.first))) / 255.0f;
}

TextureSampler::TextureSampler(const Texture& texture, Encoding encoding)
    : wrap_u_(texture.wrap_u), wrap_v_(texture.wrap_v), nearest_(texture.nearest) {
  WARETWIN_CHECK(texture.width > 0 && texture.height > 0, "a texture has texels");
  WARETWIN_CHECK(texture.rgba.size() == std::size_t{4} * static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height),
                 "a texture has four bytes a texel");
  size_ = std::sqrt(static_cast<float>(texture.width) * static_cast<float>(texture.height));
  const auto colour = sixteen_bits(encoding), alpha = sixteen_bits(Encoding::kLinear);
  Level& full = levels_.emplace_back(Level{texture.width, texture.height, {}});
  full.rgba.resize(texture.rgba.size());
  for (std::size_t i = 0; i < full.rgba.size(); ++i) full.rgba[i] = (i % 4 == 3 ? alpha : colour)[texture.rgba[i]];
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(half_of(levels_.back()));
}

TextureSampler::Level TextureSampler::half_of(const Level& finer) {
  Level level;
  level.width = std::max(1, finer.width / 2);
  level.height = std::max(1, finer.height / 2);
  level.rgba.resize(std::size_t{4} * static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
  const auto texel = [&finer](int x, int y) {
    x = std::min(x, finer.width - 1);
    y = std::min(y, finer.height - 1);
    return &finer.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(finer.width) + static_cast<std::size_t>(x))];
  };
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      const std::uint16_t* in[4] = {texel(2 * x, 2 * y), texel(2 * x + 1, 2 * y), texel(2 * x, 2 * y + 1), texel(2 * x + 1, 2 * y + 1)};
      std::uint16_t* out =
          &level.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x))];
      for (int c = 0; c < 4; ++c) out[c] = static_cast<std::uint16_t>((in[0][c] + in[1][c] + in[2][c] + in[3][c] + 2) / 4);
    }
  }
  return level;
}

int TextureSampler::level(float footprint) const {
  const float texels = footprint * size_;
  if (!(texels > 1.4142135f)) return 0;
  return std::clamp(exponent(texels * 1.4142135f), 0, static_cast<int>(levels_.size()) - 1);
}

Eigen::Vector4f TextureSampler::sample_level(const Eigen::Vector2f& uv, int index) const {
  const Level& level = levels_[static_cast<std::size_t>(index)];
  const bool nearest = nearest_ && index == 0;
  const Taps tx = taps(uv.x(), level.width, wrap_u_, nearest), ty = taps(uv.y(), level.height, wrap_v_, nearest);
  const auto at = [&level](int x, int y) {
    return &level.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x))];
  };
  const float fx = tx.share, fy = ty.share, scale = 1.0f / 65535.0f;
  const float top = scale * (1.0f - fy), low = scale * fy;
  // Four channels at once, by the compilers' vector extension (GCC and Clang).
  using Four = float __attribute__((vector_size(16)));
  using Words = std::uint16_t __attribute__((vector_size(8)));
  const auto texel = [&at](int x, int y) {
    Words words;
    std::memcpy(&words, at(x, y), sizeof words);
    return __builtin_convertvector(words, Four);
  };
  const Four sum = (1.0f - fx) * top * texel(tx.first, ty.first) + fx * top * texel(tx.second, ty.first) +
                   (1.0f - fx) * low * texel(tx.first, ty.second) + fx * low * texel(tx.second, ty.second);
  Eigen::Vector4f out;
  std::memcpy(out.data(), &sum, sizeof sum);
  return out;
}

}  // namespace waretwin
