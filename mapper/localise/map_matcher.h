// Laying a scan onto the local map: robust point-to-line least squares with odometry as prior.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/localise/local_map.h"

namespace waretwin {

// What is known of a pose before the match: mean and information (inverse covariance) of (x, y, yaw) in S. The information may be singular.
struct PosePrior {
  PlanarMotion X_SB;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

struct MapMatch {
  PlanarMotion X_SB;                                      // prior and scan together
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of (x, y, yaw) from the scan alone; zero along a direction it does not hold
  double matched_fraction = 0.0;                          // of the scan's points that lie on the map
  double residual_m = 0.0;                                // root mean square of those
  double sigma_m = 0.0;     // standard deviation given to a residual: its spread, with the floor of the configuration
  bool degenerate = false;  // one direction was left to the prior
  Eigen::Vector2d loose = Eigen::Vector2d::Zero();  // that direction, unit, in S
  int iterations = 0;
  bool believable = false;   // enough points matched and the residual small, by the configuration's limits
  std::vector<int> matched;  // the map's points that the matched ones lie on, one for each
  // What the match says about the range bias, pose and all else left free: information (1 / m^2) and information times the change that
  // it asks for.
  double bias_information = 0.0, bias_vector = 0.0;
};

// Gauss-Newton on sum w_i (n_i . (R p_i + t - q_i))^2 / sigma^2 + prior, with Geman-McClure weights whose scale begins wide and then
// follows the residuals' spread (Chebrolu et al., "Adaptive robust kernels for non-linear least squares problems", RA-L 2021, name the
// family). `bias` is taken off each range of the scan. The search begins at `start`. A direction of translation that fewer than
// degenerate_beams points hold (each counts with the squared cosine between its normal and the direction; normals beyond 70 deg count for
// nothing, they are noise) is projected out of the scan's equations, so that the prior alone decides there (Zhang, Kaess, Singh, "On
// degeneracy of optimization-based state estimation problems", ICRA 2016). Too few correspondences give believable = false and the prior's
// pose; nothing is thrown. Deterministic, single-threaded.
MapMatch match_to_map(const LocalMap& map, const std::vector<ScanPoint>& points_B, const PosePrior& prior, const PlanarMotion& start,
                      double bias, const MapMatchConfig& config);

}  // namespace waretwin
