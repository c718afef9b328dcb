#include <gtest/gtest.h>

#include <map>
#include <random>

#include "mapper/integrate/label_counts.h"

namespace waretwin {
namespace {

using Reference = std::map<std::pair<int, std::int32_t>, std::uint32_t>;

std::int32_t best(const Reference& reference, int voxel) {
  std::int32_t label = 0;
  std::uint32_t most = 0;
  for (const auto& [key, count] : reference) {
    if (key.first == voxel && count > most) {
      most = count;
      label = key.second;
    }
  }
  return label;
}

void expect_equal(const LabelCounts& counts, const Reference& reference, int labels) {
  for (int voxel = 0; voxel < LabelCounts::kVoxels; ++voxel) {
    std::vector<std::pair<std::int32_t, std::uint32_t>> all;
    for (auto e = reference.lower_bound({voxel, 0}); e != reference.end() && e->first.first == voxel; ++e)
      all.emplace_back(e->first.second, e->second);
    ASSERT_EQ(counts.all(voxel), all) << voxel;
    ASSERT_EQ(counts.best(voxel), best(reference, voxel)) << voxel;
    for (std::int32_t label = 0; label < labels; ++label) {
      const auto found = reference.find({voxel, label});
      ASSERT_EQ(counts.count(voxel, label), found == reference.end() ? 0u : found->second);
    }
  }
}

TEST(LabelCounts, EqualAMapOnRandomInput) {
  for (const int labels : {2, 5, 60}) {
    std::mt19937 random(static_cast<unsigned>(labels));
    LabelCounts counts;
    Reference reference;
    for (int i = 0; i < 20000; ++i) {
      const int voxel = static_cast<int>(random() % 512);
      const auto label = static_cast<std::int32_t>(random() % static_cast<unsigned>(labels));
      const std::uint32_t times = 1 + random() % 3;
      counts.add(voxel, label, times);
      reference[{voxel, label}] += times;
    }
    expect_equal(counts, reference, labels);
  }
}

TEST(LabelCounts, MergesLikeAMap) {
  std::mt19937 random(11);
  LabelCounts counts;
  Reference reference;
  for (int i = 0; i < 4000; ++i) {
    const int voxel = static_cast<int>(random() % 512);
    const auto label = static_cast<std::int32_t>(random() % 9);
    counts.add(voxel, label);
    ++reference[{voxel, label}];
  }
  for (const auto& [from, to] : std::vector<std::pair<int, int>>{{3, 1}, {8, 12}, {0, 5}, {2, 2}, {7, 12}}) {
    counts.merge(from, to);
    Reference merged;
    for (const auto& [key, count] : reference) merged[{key.first, key.second == from ? to : key.second}] += count;
    reference = merged;
    expect_equal(counts, reference, 13);
  }
}

TEST(LabelCounts, ThousandLabelsInOneVoxelAreAllKept) {
  LabelCounts counts;
  for (std::int32_t label = 999; label >= 0; --label) counts.add(17, label, label == 640 ? 3 : 2);
  EXPECT_EQ(counts.all(17).size(), 1000u);
  EXPECT_EQ(counts.best(17), 640);
  EXPECT_TRUE(counts.all(16).empty());
}

TEST(LabelCounts, SmallestOfEqualLabelsWins) {
  LabelCounts counts;
  counts.add(0, 9);
  counts.add(0, 4);
  counts.add(0, 6);
  EXPECT_EQ(counts.best(0), 4);
  counts.add(0, 9);
  EXPECT_EQ(counts.best(0), 9);
  EXPECT_EQ(counts.best(1), 0);
}

TEST(LabelCounts, CountsStopAtTheirLimit) {
  LabelCounts counts;
  counts.add(3, 1, 0xfffffffeu);
  counts.add(3, 1, 5);
  EXPECT_EQ(counts.count(3, 1), 0xffffffffu);
}

}  // namespace
}  // namespace waretwin
