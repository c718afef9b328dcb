#include "harness/noise/noise_laws.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

constexpr double kNormal95 = 1.959964;
constexpr double kBestTrust = 0.02;

// One line of a least-squares problem, already divided by its standard error.
struct Line {
  Eigen::Vector2d row;
  double value;
};

struct Fit {
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_width = Eigen::Vector2d::Zero();  // of the 95 % intervals
  double misfit = 0.0;
};

double standard_error(const Estimate& sigma) { return std::hypot((sigma.high - sigma.low) / (2.0 * kNormal95), kBestTrust * sigma.value); }

// The unknowns that `used` names; the others stay 0.
std::optional<Fit> solve(const std::vector<Line>& lines, const std::vector<Eigen::Index>& used) {
  const auto unknowns = static_cast<Eigen::Index>(used.size());
  if (lines.size() <= used.size()) return std::nullopt;
  Eigen::MatrixXd A(static_cast<Eigen::Index>(lines.size()), unknowns);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const Line& line = lines[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < unknowns; ++k) A(i, k) = line.row[used[static_cast<std::size_t>(k)]];
    b[i] = line.value;
  }
  const Eigen::MatrixXd squares = A.transpose() * A;
  // Of two columns that are multiples of each other only a sum is known.
  if (squares.determinant() < 1e-6 * squares.diagonal().prod()) return std::nullopt;
  const Eigen::MatrixXd covariance = squares.inverse();
  const Eigen::VectorXd x = covariance * (A.transpose() * b);
  const auto freedom = static_cast<double>(A.rows() - unknowns);
  Fit fit;
  fit.misfit = (A * x - b).squaredNorm() / freedom;
  // Where the cells scatter as they should, their own errors count; where they scatter more, the law is only that good.
  const double widening = std::max(1.0, fit.misfit);
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const Eigen::Index at = used[static_cast<std::size_t>(k)];
    fit.x[at] = x[k];
    fit.half_width[at] = student_95(freedom) * std::sqrt(widening * covariance(k, k));
  }
  return fit;
}

Estimate estimate(const Fit& fit, Eigen::Index k) { return {fit.x[k], fit.x[k] - fit.half_width[k], fit.x[k] + fit.half_width[k]}; }

// Cells whose noise drowns in the rounding hold no figure to compare with.
bool counts(const Estimate& sigma) { return sigma.value > 0.0 && sigma.high > sigma.low; }

// Root mean square of the values over what the fit says of them, less 1.
double relative_rms(const std::vector<Line>& lines, const Fit& fit) {
  double squares = 0.0;
  for (const Line& line : lines) {
    const double relative = line.value / line.row.dot(fit.x) - 1.0;
    squares += relative * relative;
  }
  return std::sqrt(squares / static_cast<double>(lines.size()));
}

}  // namespace

double time_of_flight_shape(double signal, double background) { return std::sqrt(signal + background) / signal; }

double student_95(double freedom) {
  WARETWIN_CHECK(freedom >= 1.0, "an interval needs a degree of freedom");
  // The expansion is of no use for the heaviest tails.
  if (freedom < 2.0) return 12.706;
  if (freedom < 3.0) return 4.303;
  const double z = kNormal95, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * freedom) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * freedom * freedom * freedom);
}

Estimate sigma_of_variances(std::vector<double> variances, double freedom) {
  WARETWIN_CHECK(!variances.empty(), "a median needs values");
  std::sort(variances.begin(), variances.end());
  const auto count = static_cast<double>(variances.size());
  const auto at = [&](double rank) {  // linear between neighbours
    const double place = std::clamp(rank, 0.0, count - 1.0);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, variances.size() - 1);
    return variances[below] + (place - static_cast<double>(below)) * (variances[above] - variances[below]);
  };
  const double root = 1.0 - 2.0 / (9.0 * freedom);
  const auto sigma = [&](double variance) { return std::sqrt(std::max(0.0, variance) / (root * root * root)); };
  // The number of values below the true median is binomial.
  const double middle = 0.5 * (count - 1.0), half = 0.5 * kNormal95 * std::sqrt(count);
  return {sigma(at(middle)), sigma(at(middle - half)), sigma(at(middle + half))};
}

std::optional<GaussianLaw> fit_gaussian_law(const std::vector<NoiseCell>& cells) {
  std::vector<Line> lines;
  for (const NoiseCell& cell : cells) {
    if (!counts(cell.sigma_z)) continue;
    const double error = standard_error(cell.sigma_z);
    lines.push_back({Eigen::Vector2d(1.0, cell.depth_m * cell.depth_m) / error, cell.sigma_z.value / error});
  }
  std::optional<Fit> fit = solve(lines, {0, 1});
  if (!fit) return std::nullopt;
  GaussianLaw law;
  if (fit->x.minCoeff() < 0.0) {
    law.at_limit = true;
    fit = solve(lines, {fit->x[0] < 0.0 ? Eigen::Index{1} : Eigen::Index{0}});
    if (!fit) return std::nullopt;
  }
  law.base_m = estimate(*fit, 0);
  law.growth_per_m = estimate(*fit, 1);
  law.misfit = fit->misfit;
  law.relative_rms = relative_rms(lines, *fit);
  return law;
}

std::optional<TimeOfFlightLaw> fit_time_of_flight_law(const std::vector<NoiseCell>& cells) {
  std::vector<Line> lines;
  for (const NoiseCell& cell : cells) {
    if (!counts(cell.sigma_r)) continue;
    const double error = standard_error(cell.sigma_r);
    lines.push_back({Eigen::Vector2d(cell.shape, 0.0) / error, cell.sigma_r.value / error});
  }
  const std::optional<Fit> fit = solve(lines, {0});
  if (!fit) return std::nullopt;
  TimeOfFlightLaw law;
  law.noise_m = estimate(*fit, 0);
  law.misfit = fit->misfit;
  law.relative_rms = relative_rms(lines, *fit);
  return law;
}

}  // namespace waretwin
