// Laying one laser scan onto another: point-to-line ICP (Censi, ICRA 2008).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/localise/laser_icp_config.h"
#include "mapper/localise/point_to_line.h"

namespace waretwin {

// A scan that others are matched against, with the line at each point and a grid for the search of neighbours.
class ReferenceScan {
 public:
  // Points in the order of the beams (metres); a gap in angle needs no mark, lines do not reach over gaps in distance.
  ReferenceScan(std::vector<Eigen::Vector2d> points, const ScanMatchConfig& config);

  struct Line {
    Eigen::Vector2d on_line = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  // unit; zero where the neighbourhood is no line
    double reach = 0.0;                                // metres along the line from on_line to where its points end
  };

  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  const std::vector<Line>& lines() const { return lines_; }
  // Index of the point nearest to p within max_distance (the lowest index of several), -1 where there is none.
  int nearest(const Eigen::Vector2d& p, double max_distance) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<Line> lines_;
  double cell_ = 0.1;  // metres
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<int> cell_start_, cell_points_;
};

struct ScanMatch {
  PlanarMotion X_RS;                     // reference <- scan: p_R = X_RS * p_S
  double residual_m = 0.0;               // root mean square distance from the lines, kept correspondences only
  double matched_fraction = 0.0;         // kept correspondences / points of the scan
  double translation_information = 0.0;  // see PointToLineSolution; below about 0.02 one direction is the guess's (a corridor)
  int iterations = 0;
  bool converged = false;   // ended by a small step, or by coming back to where it was
  bool believable = false;  // enough points matched and the residual small, by the configuration's limits
};

// X_RS that lays points_S onto the reference, starting from `guess`. Too few correspondences give converged = believable = false and the
// guess itself; nothing is thrown. Deterministic, single-threaded.
ScanMatch match_scans(const ReferenceScan& reference, const std::vector<Eigen::Vector2d>& points_S, const PlanarMotion& guess,
                      const ScanMatchConfig& config);

}  // namespace waretwin
