#include "harness/score/assignment.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace waretwin {

std::vector<int> assign_largest(const Eigen::MatrixXd& weights) {
  const auto rows = static_cast<int>(weights.rows());
  const auto columns = static_cast<int>(weights.cols());
  const int n = std::max(rows, columns);
  const auto cost = [&](int row, int column) {
    if (row >= rows || column >= columns) return 0.0;  // pads the problem to a square: no partner
    const double weight = weights(row, column);
    WARETWIN_CHECK(weight >= 0.0, "weights of an assignment are not negative");
    return -weight;
  };

  // Row 0 and column 0 stand for "none" in the search of augmenting paths, real ones count from 1.
  const auto size = static_cast<std::size_t>(n) + 1;
  std::vector<double> row_potential(size, 0.0), column_potential(size, 0.0);
  std::vector<int> row_of(size, 0), previous(size, 0);
  for (int row = 1; row <= n; ++row) {
    row_of[0] = row;
    int column = 0;
    std::vector<double> slack(size, std::numeric_limits<double>::infinity());
    std::vector<char> used(size, 0);
    do {
      used[static_cast<std::size_t>(column)] = 1;
      const int current = row_of[static_cast<std::size_t>(column)];
      double delta = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int j = 1; j <= n; ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (used[k]) continue;
        const double reduced = cost(current - 1, j - 1) - row_potential[static_cast<std::size_t>(current)] - column_potential[k];
        if (reduced < slack[k]) {
          slack[k] = reduced;
          previous[k] = column;
        }
        if (slack[k] < delta) {
          delta = slack[k];
          next = j;
        }
      }
      for (std::size_t k = 0; k < size; ++k) {
        if (used[k]) {
          row_potential[static_cast<std::size_t>(row_of[k])] += delta;
          column_potential[k] -= delta;
        } else {
          slack[k] -= delta;
        }
      }
      column = next;
    } while (row_of[static_cast<std::size_t>(column)] != 0);
    do {
      const int from = previous[static_cast<std::size_t>(column)];
      row_of[static_cast<std::size_t>(column)] = row_of[static_cast<std::size_t>(from)];
      column = from;
    } while (column != 0);
  }

  std::vector<int> partner(static_cast<std::size_t>(rows), -1);
  for (int column = 1; column <= columns; ++column) {
    const int row = row_of[static_cast<std::size_t>(column)];
    if (row >= 1 && row <= rows && weights(row - 1, column - 1) > 0.0) partner[static_cast<std::size_t>(row) - 1] = column - 1;
  }
  return partner;
}

}  // namespace waretwin
