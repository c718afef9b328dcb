#include "harness/study/main_effects.h"

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core/error.h"

namespace waretwin {

std::vector<std::vector<std::optional<Interval>>> main_effects(const std::vector<LevelledValue>& values,
                                                               const std::vector<std::size_t>& level_counts, double confidence) {
  const std::size_t factors = level_counts.size();
  std::vector<std::vector<std::optional<Interval>>> effects(factors);
  for (std::size_t f = 0; f < factors; ++f) {
    effects[f].resize(level_counts[f]);
    for (const LevelledValue& value : values) {
      WARETWIN_CHECK(value.levels.size() == factors && value.levels[f] < level_counts[f], "a level of each factor");
      std::optional<Interval>& interval = effects[f][value.levels[f]];
      if (!interval) interval.emplace();
      ++interval->count;
      interval->mean += value.value;
    }
    for (std::optional<Interval>& interval : effects[f]) {
      if (interval) interval->mean /= interval->count;
    }
  }
  // A column for the constant and one for each level that occurs but the factor's first one.
  std::vector<std::vector<Eigen::Index>> column(factors);
  Eigen::Index columns = 1;
  std::vector<double> occurring(factors, 0.0);
  for (std::size_t f = 0; f < factors; ++f) {
    bool first = true;
    for (const std::optional<Interval>& interval : effects[f]) {
      column[f].push_back(interval && !first ? columns++ : -1);
      if (!interval) continue;
      first = false;
      occurring[f] += 1.0;
    }
  }
  const auto rows = static_cast<Eigen::Index>(values.size());
  if (rows < columns) return effects;
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(rows, columns);
  Eigen::VectorXd y(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const LevelledValue& value = values[static_cast<std::size_t>(row)];
    X(row, 0) = 1.0;
    y[row] = value.value;
    for (std::size_t f = 0; f < factors; ++f) {
      const Eigen::Index k = column[f][value.levels[f]];
      if (k > 0) X(row, k) = 1.0;
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(X);
  if (solver.rank() < columns) return effects;
  const Eigen::VectorXd terms = solver.solve(y);
  const Eigen::MatrixXd covariance = (X.transpose() * X).inverse();
  const auto freedom = static_cast<double>(rows - columns);
  const double variance = freedom > 0.0 ? (y - X * terms).squaredNorm() / freedom : 0.0;
  for (std::size_t f = 0; f < factors; ++f) {
    for (std::size_t level = 0; level < level_counts[f]; ++level) {
      std::optional<Interval>& interval = effects[f][level];
      if (!interval) continue;
      // The level itself, and of every other factor all levels alike.
      Eigen::VectorXd weights = Eigen::VectorXd::Zero(columns);
      weights[0] = 1.0;
      for (std::size_t g = 0; g < factors; ++g) {
        for (std::size_t other = 0; other < level_counts[g]; ++other) {
          if (column[g][other] > 0) weights[column[g][other]] = g == f ? (other == level ? 1.0 : 0.0) : 1.0 / occurring[g];
        }
      }
      interval->mean = weights.dot(terms);
      if (!(freedom > 0.0)) continue;
      const boost::math::students_t t(freedom);
      const double half = boost::math::quantile(t, 0.5 + 0.5 * confidence) * std::sqrt(variance * weights.dot(covariance * weights));
      interval->low = interval->mean - half;
      interval->high = interval->mean + half;
    }
  }
  return effects;
}

}  // namespace waretwin
