#include "harness/score/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/random.h"

namespace waretwin {
namespace {

double total(const Eigen::MatrixXd& weights, const std::vector<int>& partner) {
  double sum = 0.0;
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] >= 0) sum += weights(static_cast<Eigen::Index>(i), partner[i]);
  }
  return sum;
}

// Tries every way to give rows distinct columns.
double best_by_force(const Eigen::MatrixXd& weights) {
  const auto n = static_cast<int>(std::max(weights.rows(), weights.cols()));
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  double best = 0.0;
  do {
    double sum = 0.0;
    for (Eigen::Index row = 0; row < weights.rows(); ++row) {
      const int column = order[static_cast<std::size_t>(row)];
      if (column < weights.cols()) sum += weights(row, column);
    }
    best = std::max(best, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(Assignment, PrefersTheLargestSumToTheLargestSingleWeight) {
  Eigen::MatrixXd weights(2, 2);
  weights << 0.9, 0.8, 0.8, 0.1;  // greedy: 0.9 + 0.1; best: 0.8 + 0.8
  EXPECT_EQ(assign_largest(weights), (std::vector<int>{1, 0}));
}

TEST(Assignment, NeverPairsAWeightOfZero) {
  Eigen::MatrixXd weights(2, 2);
  weights << 0.5, 0.0, 0.4, 0.0;
  EXPECT_EQ(assign_largest(weights), (std::vector<int>{0, -1}));
}

TEST(Assignment, TakesEmptySides) {
  EXPECT_TRUE(assign_largest(Eigen::MatrixXd(0, 3)).empty());
  EXPECT_EQ(assign_largest(Eigen::MatrixXd(2, 0)), (std::vector<int>{-1, -1}));
}

TEST(Assignment, ReachesTheBestSumOfAllAssignments) {
  const RandomStream random(7, "assignment", "weights");
  std::uint64_t index = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto rows = static_cast<Eigen::Index>(1 + 6 * random.uniform(index++));
    const auto columns = static_cast<Eigen::Index>(1 + 6 * random.uniform(index++));
    Eigen::MatrixXd weights(rows, columns);
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const double value = random.uniform(index++);
      weights(i) = value < 0.4 ? 0.0 : value;  // many forbidden pairs
    }
    const std::vector<int> partner = assign_largest(weights);
    std::vector<int> used;
    for (const int column : partner) {
      if (column >= 0) used.push_back(column);
    }
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::adjacent_find(used.begin(), used.end()), used.end()) << "a column was given away twice";
    EXPECT_NEAR(total(weights, partner), best_by_force(weights), 1e-12);
  }
}

}  // namespace
}  // namespace waretwin
