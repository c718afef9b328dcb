// Where the vehicle can stand and turn, and the shortest ways between such places.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenes/generate/hall_plan.h"

namespace waretwin::generate {

// The floor as a grid of places, each free when a disc of `radius` around it meets nothing up to the camera's height.
class FreeSpace {
 public:
  FreeSpace(const HallPlan& plan, double radius);

  double spacing() const { return spacing_; }
  // Free places, in a fixed order: those that a vehicle can reach from the largest open part of the hall.
  const std::vector<Eigen::Vector2d>& places() const { return places_; }
  // The free place nearest to a point; the grid must have one.
  std::size_t nearest(const Eigen::Vector2d& p) const;

  // Metres along the grid from one place to every other.
  std::vector<double> distances(std::size_t from) const;
  // Corners of a short way that a disc of the radius can follow, both ends included.
  std::vector<Eigen::Vector2d> way(std::size_t from, std::size_t to) const;
  bool clear(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  std::vector<Eigen::Vector2d> few_corners(const std::vector<Eigen::Vector2d>& knots) const;
  bool is_free(const Eigen::Vector2d& p) const;
  void spread(std::size_t from, std::vector<double>& distance, std::vector<int>& before) const;

  double radius_, spacing_;
  Eigen::Vector2d limit_;  // half the floor, less what the vehicle needs
  std::vector<Solid> obstacles_;
  int columns_ = 0, rows_ = 0;
  std::vector<int> index_;  // of the place in each cell; -1: none
  std::vector<Eigen::Vector2d> places_;
  std::vector<int> cells_;  // of each place
};

}  // namespace waretwin::generate
