#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/sample_statistics.h"

namespace waretwin {
namespace {

constexpr std::size_t kSamples = 100000;
// A correlation of independent samples stays below this with 99.9 % confidence.
const double kCorrelationBound = 3.3 / std::sqrt(static_cast<double>(kSamples));

std::vector<double> uniforms(const RandomStream& stream) {
  std::vector<double> out;
  for (std::uint64_t i = 0; i < kSamples; ++i) out.push_back(stream.uniform(i));
  return out;
}

TEST(Philox, KnownAnswers) {
  using Words = std::array<std::uint32_t, 4>;
  // The "philox4x32 10" lines of Random123's kat_vectors.
  EXPECT_EQ(philox_words({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox_words({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox_words({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, IsAPureFunctionOfItsKeys) {
  const RandomStream a(1, "camera", "noise", 7);
  const RandomStream b(1, "camera", "noise", 7);
  EXPECT_EQ(a.words(99, 3), b.words(99, 3));
  const auto first = a.words(5);
  a.words(1000);
  EXPECT_EQ(a.words(5), first);
}

TEST(RandomStream, EveryKeyMatters) {
  std::set<std::array<std::uint32_t, 4>> seen;
  int streams = 0;
  for (const std::uint64_t seed : {0ull, 1ull, 1ull << 40}) {
    for (const char* sensor : {"camera", "laser", ""}) {
      for (const char* purpose : {"noise", "bias"}) {
        for (const Stamp stamp : {Stamp{0}, Stamp{1}, Stamp{-1}, Stamp{1} << 50}) {
          for (const std::uint64_t index : {0ull, 1ull, 1ull << 33}) {
            for (const std::uint32_t draw : {0u, 1u}) {
              seen.insert(RandomStream(seed, sensor, purpose, stamp).words(index, draw));
              ++streams;
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), streams);
  // The border between the two names counts.
  EXPECT_NE(RandomStream(1, "ab", "c").words(0), RandomStream(1, "a", "bc").words(0));
  EXPECT_NE(RandomStream(1, "a", "b").words(0), RandomStream(1, "b", "a").words(0));
}

TEST(RandomStream, UniformIsUniform) {
  const std::vector<double> x = uniforms(RandomStream(1, "test", "uniform"));
  EXPECT_LT(test::ks_distance(x, [](double v) { return v; }), 1.63 / std::sqrt(static_cast<double>(kSamples)));
  for (const double v : x) {
    ASSERT_GE(v, 0.0);
    ASSERT_LT(v, 1.0);
  }
}

TEST(RandomStream, NormalIsNormal) {
  const RandomStream stream(2, "test", "normal");
  std::vector<double> single, first, second;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    single.push_back(stream.normal(i));
    const auto pair = stream.normal_pair(i, 1);
    first.push_back(pair[0]);
    second.push_back(pair[1]);
  }
  for (const auto* x : {&single, &first, &second}) {
    EXPECT_LT(test::ks_distance(*x, test::normal_cdf), 1.63 / std::sqrt(static_cast<double>(kSamples)));
    EXPECT_GT(test::sample_variance(*x), test::variance_ratio_low(kSamples));
    EXPECT_LT(test::sample_variance(*x), test::variance_ratio_high(kSamples));
  }
  EXPECT_LT(std::abs(test::correlation(first, second)), kCorrelationBound);
  EXPECT_LT(std::abs(test::correlation(single, first)), kCorrelationBound);
}

TEST(RandomStream, PairsStayBelowOne) {
  const RandomStream stream(3, "test", "pairs");
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    for (const float v : stream.uniform_pair(i)) {
      ASSERT_GE(v, 0.0f);
      ASSERT_LT(v, 1.0f);
    }
  }
}

TEST(RandomStream, StreamsAreIndependent) {
  const std::vector<double> base = uniforms(RandomStream(1, "camera", "noise", 0));
  for (const RandomStream& other : {RandomStream(2, "camera", "noise", 0), RandomStream(1, "camera2", "noise", 0),
                                    RandomStream(1, "camera", "dropout", 0), RandomStream(1, "camera", "noise", 1)}) {
    EXPECT_LT(std::abs(test::correlation(base, uniforms(other))), kCorrelationBound);
  }
}

TEST(RandomStream, FillGivesTheSameWords) {
  const RandomStream stream(4, "test", "fill", 9);
  std::vector<std::array<std::uint32_t, 4>> out(100);
  const std::uint64_t first = (std::uint64_t{1} << 32) - 50;
  stream.fill(first, out.size(), out.data());
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(out[i], stream.words(first + i));
}

}  // namespace
}  // namespace waretwin
