// The surroundings as a set of oriented points that many scans have been averaged into; scans are matched against it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapper/localise/point_to_line.h"
#include "mapper/localise/scan_points.h"

namespace waretwin {

// The mean of all points of one surface in one cell.
struct MapPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // mean of ScanPoint::direction; shorter than 1 where it was seen from many sides
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();     // unit
  double count = 0.0;                                   // points that were averaged
  int first_seen = 0;                                   // the earliest of the keyframes that see it, by the number given to LocalMap::add
};

class LocalMap {
 public:
  // Cells of `cell_m` metres. Points of one cell whose normals point into different eighths of the circle are kept apart: the two sides of
  // a thin wall, or of a corner.
  explicit LocalMap(double cell_m) : cell_m_(cell_m) {}

  // Adds the points of keyframe number `keyframe`, in its frame K, which stands at X_SK; `bias` (metres) is taken off each range.
  void add(const std::vector<ScanPoint>& points_K, const PlanarMotion& X_SK, double bias, int keyframe);
  // Averages and sorts what was added so far; to be called before the questions below. More may be added afterwards.
  void finish();

  const std::vector<MapPoint>& points() const { return points_; }
  // Index of the nearest point within max_distance whose normal makes an angle with `normal` of at most acos(min_cosine); -1 where there is
  // none. The lowest index of several.
  int nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal, double max_distance, double min_cosine) const;
  // Points added on the mean to each of points().
  double mean_count() const { return mean_count_; }

 private:
  double cell_m_;
  std::vector<MapPoint> sums_;
  std::vector<MapPoint> points_;
  std::unordered_map<std::uint64_t, int> index_;  // only looked up, never walked through: its order does not matter
  double mean_count_ = 1.0;
  // A grid over the points, row by row; cell_start_[c] .. cell_start_[c + 1] in ordered_.
  double grid_m_ = 0.1;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<int> cell_start_;
  struct Entry {
    Eigen::Vector2d p, normal;
    int index;
  };
  std::vector<Entry> ordered_;
};

}  // namespace waretwin
