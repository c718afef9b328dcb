// How high a hall's own things reach, seen from above: where something can be put, and from where it can fall.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "scenes/scene.h"

namespace waretwin {

// Where one walks in a hall whose lowest point is `lowest`: slabs reach below the floor; of what is near z = 0, as the vehicle's own floor
// is.
double floor_of(double lowest);

class HallHeights {
 public:
  // Cells of `cell_m`. Surfaces higher than `below_m` above the lowest (lamps, the ceiling) do not count; movers do not either.
  explicit HallHeights(const Scene& scene, double cell_m = 0.05, double below_m = 2.0);

  // The ground of the hall, inside its bounds.
  const Eigen::AlignedBox2d& area() const { return area_; }
  double floor() const { return floor_; }
  // Highest surface at a place in the world; `floor()` outside.
  double at(const Eigen::Vector2d& p_W) const;
  // Nothing reaches more than 3 cm above the floor within an upright box on it, nor is any of it outside or taken.
  bool is_free(const Eigen::Vector2d& centre_W, const Eigen::Vector2d& size, double yaw) const;
  // Marks all cells within `radius` as taken.
  void take(const Eigen::Vector2d& p_W, double radius);

 private:
  bool cell(const Eigen::Vector2d& p_W, std::size_t& index) const;

  double cell_, floor_ = 0.0;
  int width_ = 0, height_ = 0;
  Eigen::AlignedBox2d area_;
  std::vector<float> heights_;  // above the floor
  std::vector<bool> taken_;
};

}  // namespace waretwin
