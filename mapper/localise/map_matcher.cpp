#include "mapper/localise/map_matcher.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose.h"

namespace waretwin {
namespace {

constexpr std::size_t kFewestPairs = 10;
constexpr double kNoiseCosine = 0.35;  // 70 deg

struct Pair {
  Eigen::Vector2d arm;     // R p: from the base to the point, in S
  Eigen::Vector2d normal;  // of the map
  double residual = 0.0;   // n . (p_S - q)
  double by_bias = 0.0;    // its derivative by the range bias
  double weight = 1.0;
  int map_point = 0;
};

double quantile(std::vector<double>& values, double order) {
  const std::size_t at = std::min(values.size() - 1, static_cast<std::size_t>(order * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<Pair> correspondences(const LocalMap& map, const std::vector<ScanPoint>& points_B, const PlanarMotion& X_SB, double bias,
                                  double max_distance, double min_cosine) {
  const Eigen::Matrix2d R = X_SB.rotation();
  std::vector<Pair> pairs;
  pairs.reserve(points_B.size());
  for (const ScanPoint& point : points_B) {
    Pair pair;
    pair.arm = R * (point.p - bias * point.direction);
    const Eigen::Vector2d p_S = pair.arm + X_SB.translation;
    const int nearest = map.nearest(p_S, R * point.normal, max_distance, min_cosine);
    if (nearest < 0) continue;
    const MapPoint& there = map.points()[static_cast<std::size_t>(nearest)];
    pair.map_point = nearest;
    pair.normal = there.normal;
    pair.residual = there.normal.dot(p_S - there.p);
    pair.by_bias = there.normal.dot(there.direction - R * point.direction);
    pairs.push_back(pair);
  }
  return pairs;
}

// Standard deviation of the residuals' inner part.
double spread(const std::vector<Pair>& pairs) {
  std::vector<double> sizes;
  sizes.reserve(pairs.size());
  for (const Pair& pair : pairs) sizes.push_back(std::abs(pair.residual));
  return 1.4826 * quantile(sizes, 0.5);
}

// The direction that the points hold least, and how many hold it.
double weakest_direction(const std::vector<Pair>& pairs, Eigen::Vector2d& direction) {
  Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
  for (const Pair& pair : pairs) N += pair.weight * pair.normal * pair.normal.transpose();
  direction = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(N).eigenvectors().col(0);
  double held = 0.0;
  for (const Pair& pair : pairs) {
    const double cosine = pair.normal.dot(direction);
    if (std::abs(cosine) > kNoiseCosine) held += pair.weight * cosine * cosine;
  }
  return held;
}

}  // namespace

MapMatch match_to_map(const LocalMap& map, const std::vector<ScanPoint>& points_B, const PosePrior& prior, const PlanarMotion& start,
                      double bias, const MapMatchConfig& config) {
  MapMatch match;
  match.X_SB = start;
  const double min_cosine = std::cos(to_radians(config.max_normal_angle_deg));
  const double rotation_epsilon = to_radians(config.rotation_epsilon_deg);
  double distance = config.max_distance_m;
  double kernel = 0.25 * config.max_distance_m;
  Eigen::Matrix3d H_scan = Eigen::Matrix3d::Zero();
  const auto give_up = [&] {
    MapMatch nothing;
    nothing.X_SB = prior.X_SB;
    nothing.iterations = match.iterations;
    return nothing;
  };
  std::vector<Pair> pairs;
  bool last_round = false;
  for (match.iterations = 0;; ++match.iterations) {
    pairs = correspondences(map, points_B, match.X_SB, bias, distance, min_cosine);
    if (pairs.size() < kFewestPairs) return give_up();
    const double sigma = spread(pairs);
    // Walls that already fit must not make outliers of those that do not yet: the kernel is wide at first.
    const bool wide = kernel > config.min_scale_m;
    const double scale = std::max({config.min_scale_m, kernel, 2.5 * sigma});
    kernel *= 0.5;
    match.sigma_m = std::max(config.min_sigma_m, sigma);
    for (Pair& pair : pairs) {
      const double ratio = pair.residual / scale;
      const double root = 1.0 / (1.0 + ratio * ratio);
      pair.weight = root * root;
    }
    match.degenerate = config.degeneracy && weakest_direction(pairs, match.loose) < config.degenerate_beams;
    const double per_variance = config.independent_share / (match.sigma_m * match.sigma_m);
    H_scan.setZero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero(), H_bias = Eigen::Vector3d::Zero();
    double bias_bias = 0.0, bias_g = 0.0;
    for (const Pair& pair : pairs) {
      Eigen::Vector2d n = pair.normal;
      Eigen::Vector3d J(n.x(), n.y(), -n.x() * pair.arm.y() + n.y() * pair.arm.x());
      if (match.degenerate) {
        n -= n.dot(match.loose) * match.loose;
        J.head<2>() = n;
      }
      const double w = pair.weight * per_variance;
      H_scan += w * J * J.transpose();
      g += w * J * pair.residual;
      H_bias += w * J * pair.by_bias;
      bias_bias += w * pair.by_bias * pair.by_bias;
      bias_g += w * pair.by_bias * pair.residual;
    }
    const Eigen::Vector3d from_prior(match.X_SB.translation.x() - prior.X_SB.translation.x(),
                                     match.X_SB.translation.y() - prior.X_SB.translation.y(), wrap_angle(match.X_SB.yaw - prior.X_SB.yaw));
    // Weak enough to leave no trace, strong enough to hold what neither scan nor prior does.
    const Eigen::Matrix3d H = H_scan + prior.information + Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal().toDenseMatrix();
    const Eigen::LDLT<Eigen::Matrix3d> factors(H);
    if (last_round || match.iterations >= config.max_iterations) {
      match.bias_information = std::max(0.0, bias_bias - H_bias.dot(factors.solve(H_bias)));
      match.bias_vector = -(bias_g - H_bias.dot(factors.solve(g + prior.information * from_prior)));
      break;
    }
    const Eigen::Vector3d step = -factors.solve(g + prior.information * from_prior);
    match.X_SB.translation += step.head<2>();
    match.X_SB.yaw = wrap_angle(match.X_SB.yaw + step.z());
    const double moved = step.head<2>().norm() + 3.0 * std::abs(step.z());
    // The fine search begins where the rough one has settled.
    if (distance > config.fine_distance_m && moved < 0.02) {
      distance = config.fine_distance_m;
    } else {
      last_round = !wide && step.head<2>().norm() <= config.translation_epsilon_m && std::abs(step.z()) <= rotation_epsilon;
    }
  }
  match.information = H_scan;
  const double limit = std::max(3.0 * match.sigma_m, 3.0 * config.min_scale_m);
  double sum = 0.0;
  std::size_t matched = 0;
  for (const Pair& pair : pairs) {
    if (std::abs(pair.residual) > limit) continue;
    ++matched;
    match.matched.push_back(pair.map_point);
    sum += pair.residual * pair.residual;
  }
  match.matched_fraction = static_cast<double>(matched) / static_cast<double>(points_B.size());
  match.residual_m = matched > 0 ? std::sqrt(sum / static_cast<double>(matched)) : 0.0;
  match.believable =
      matched >= kFewestPairs && match.matched_fraction >= config.min_matched_fraction && match.residual_m <= config.max_residual_m;
  return match;
}

}  // namespace waretwin
