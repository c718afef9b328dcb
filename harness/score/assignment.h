// The assignment problem: which mapped object answers to which true one.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace waretwin {

// Pairs each row with at most one column so that the sum of the weights is largest (Kuhn 1955 in the O(n^3) form with potentials). Weights
// are >= 0; a weight of 0 means that the two may not be paired. Returns the column of every row, -1 = none. Equal sums: which of them is
// chosen depends on the weights and their order alone.
std::vector<int> assign_largest(const Eigen::MatrixXd& weights);

}  // namespace waretwin
