#include "scenes/generate/free_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "core/error.h"

namespace waretwin::generate {

namespace {

constexpr double kTallest = 1.55;        // metres: the camera's bar passes below what hangs higher
constexpr double kFlat = 0.02;           // what the wheels roll over
constexpr double kPlacesAtMost = 12000;  // the grid is coarser in large halls
constexpr double kFinest = 0.1;          // metres

struct Neighbour {
  int dx, dy;
  double length;
};
const std::array<Neighbour, 8> kNeighbours = {
    {{1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}, {1, 1, M_SQRT2}, {-1, 1, M_SQRT2}, {1, -1, M_SQRT2}, {-1, -1, M_SQRT2}}};

}  // namespace

FreeSpace::FreeSpace(const HallPlan& plan, double radius)
    : radius_(radius),
      spacing_(std::max(kFinest, std::round(std::sqrt(plan.length * plan.width / kPlacesAtMost) * 100) / 100)),
      limit_(plan.length / 2 - radius, plan.width / 2 - radius) {
  for (const Solid& solid : plan.solids) {
    if (solid.low < kTallest && solid.high > kFlat) obstacles_.push_back(solid);
  }
  columns_ = std::max(0, static_cast<int>(2 * limit_.x() / spacing_) + 1);
  rows_ = std::max(0, static_cast<int>(2 * limit_.y() / spacing_) + 1);
  const auto middle_of = [&](int x, int y) {
    return Eigen::Vector2d(spacing_ * (x - 0.5 * (columns_ - 1)), spacing_ * (y - 0.5 * (rows_ - 1)));
  };
  std::vector<char> taken(static_cast<std::size_t>(columns_ * rows_), 0);
  for (const Solid& solid : obstacles_) {
    const double reach = solid.half.norm() + radius_;
    const Eigen::Vector2d low = solid.centre - Eigen::Vector2d::Constant(reach) - middle_of(0, 0),
                          high = solid.centre + Eigen::Vector2d::Constant(reach) - middle_of(0, 0);
    for (int y = std::max(0, static_cast<int>(low.y() / spacing_)); y <= std::min(rows_ - 1, static_cast<int>(high.y() / spacing_) + 1);
         ++y) {
      for (int x = std::max(0, static_cast<int>(low.x() / spacing_));
           x <= std::min(columns_ - 1, static_cast<int>(high.x() / spacing_) + 1); ++x) {
        char& cell = taken[static_cast<std::size_t>(y * columns_ + x)];
        if (!cell && distance(middle_of(x, y), solid) < radius_) cell = 1;
      }
    }
  }
  // The largest connected part counts.
  std::vector<int> part(taken.size(), -1);
  int parts = 0, largest = -1;
  std::size_t most = 0;
  for (std::size_t start = 0; start < taken.size(); ++start) {
    if (taken[start] || part[start] >= 0) continue;
    std::vector<std::size_t> open = {start};
    part[start] = parts;
    std::size_t size = 0;
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      ++size;
      const int x = static_cast<int>(cell) % columns_, y = static_cast<int>(cell) / columns_;
      for (std::size_t k = 0; k < 4; ++k) {
        const int nx = x + kNeighbours[k].dx, ny = y + kNeighbours[k].dy;
        if (nx < 0 || ny < 0 || nx >= columns_ || ny >= rows_) continue;
        const auto next = static_cast<std::size_t>(ny * columns_ + nx);
        if (taken[next] || part[next] >= 0) continue;
        part[next] = parts;
        open.push_back(next);
      }
    }
    if (size > most) {
      most = size;
      largest = parts;
    }
    ++parts;
  }
  index_.assign(taken.size(), -1);
  for (std::size_t cell = 0; cell < taken.size(); ++cell) {
    if (largest < 0 || part[cell] != largest) continue;
    index_[cell] = static_cast<int>(places_.size());
    places_.push_back(middle_of(static_cast<int>(cell) % columns_, static_cast<int>(cell) / columns_));
    cells_.push_back(static_cast<int>(cell));
  }
}

std::size_t FreeSpace::nearest(const Eigen::Vector2d& p) const {
  WARETWIN_CHECK(!places_.empty(), "the hall has free places");
  std::size_t best = 0;
  for (std::size_t i = 1; i < places_.size(); ++i) {
    if ((places_[i] - p).squaredNorm() < (places_[best] - p).squaredNorm()) best = i;
  }
  return best;
}

// Dijkstra's algorithm.
void FreeSpace::spread(std::size_t from, std::vector<double>& distance, std::vector<int>& before) const {
  distance.assign(places_.size(), std::numeric_limits<double>::infinity());
  before.assign(places_.size(), -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[from] = 0;
  open.emplace(0.0, static_cast<int>(from));
  while (!open.empty()) {
    const auto [d, place] = open.top();
    open.pop();
    if (d > distance[static_cast<std::size_t>(place)]) continue;
    const int cell = cells_[static_cast<std::size_t>(place)], x = cell % columns_, y = cell / columns_;
    for (const Neighbour& n : kNeighbours) {
      const int nx = x + n.dx, ny = y + n.dy;
      if (nx < 0 || ny < 0 || nx >= columns_ || ny >= rows_) continue;
      const int next = index_[static_cast<std::size_t>(ny * columns_ + nx)];
      // No cutting of corners.
      if (next < 0 || index_[static_cast<std::size_t>(y * columns_ + nx)] < 0 || index_[static_cast<std::size_t>(ny * columns_ + x)] < 0)
        continue;
      const double to_next = d + n.length * spacing_;
      if (to_next >= distance[static_cast<std::size_t>(next)]) continue;
      distance[static_cast<std::size_t>(next)] = to_next;
      before[static_cast<std::size_t>(next)] = place;
      open.emplace(to_next, next);
    }
  }
}

std::vector<double> FreeSpace::distances(std::size_t from) const {
  std::vector<double> distance;
  std::vector<int> before;
  spread(from, distance, before);
  return distance;
}

bool FreeSpace::is_free(const Eigen::Vector2d& p) const {
  if (std::abs(p.x()) > limit_.x() + 1e-9 || std::abs(p.y()) > limit_.y() + 1e-9) return false;
  return std::none_of(obstacles_.begin(), obstacles_.end(), [&](const Solid& s) {
    const double reach = s.half.norm() + radius_;
    return (p - s.centre).squaredNorm() < reach * reach && distance(p, s) < radius_;
  });
}

bool FreeSpace::clear(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  constexpr double kStep = 0.04;  // metres; between samples the disc comes nearer by at most 0.4 mm
  const int steps = 1 + static_cast<int>((to - from).norm() / kStep);
  for (int i = 0; i <= steps; ++i) {
    if (!is_free(from + (to - from) * i / steps)) return false;
  }
  return true;
}

std::vector<Eigen::Vector2d> FreeSpace::way(std::size_t from, std::size_t to) const {
  std::vector<double> distance;
  std::vector<int> before;
  spread(to, distance, before);
  WARETWIN_CHECK(before[from] >= 0 || from == to, "places are connected");
  std::vector<Eigen::Vector2d> steps = {places_[from]};
  for (int place = static_cast<int>(from); place != static_cast<int>(to);) {
    place = before[static_cast<std::size_t>(place)];
    steps.push_back(places_[static_cast<std::size_t>(place)]);
  }
  if (clear(steps.front(), steps.back())) return {steps.front(), steps.back()};
  // Every third step will do nearly always.
  for (const std::size_t every : {std::size_t{3}, std::size_t{1}}) {
    std::vector<Eigen::Vector2d> knots;
    for (std::size_t i = 0; i < steps.size(); i += every) knots.push_back(steps[i]);
    if ((steps.size() - 1) % every != 0) knots.push_back(steps.back());
    const std::vector<Eigen::Vector2d> corners = few_corners(knots);
    if (!corners.empty()) return corners;
  }
  return steps;
}

// Straight pieces between some of the knots: the cheapest, where each corner counts as much as driving kCorner. Empty where there are none.
std::vector<Eigen::Vector2d> FreeSpace::few_corners(const std::vector<Eigen::Vector2d>& knots) const {
  constexpr double kCorner = 1.2;  // metres
  std::vector<double> cost(knots.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> previous(knots.size(), 0);
  cost[0] = 0;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    for (std::size_t k = i + 1; k < knots.size(); ++k) {
      const double total = cost[i] + (knots[k] - knots[i]).norm() + kCorner;
      if (total >= cost[k] || !clear(knots[i], knots[k])) continue;
      cost[k] = total;
      previous[k] = i;
    }
  }
  if (std::isinf(cost.back())) return {};
  std::vector<Eigen::Vector2d> corners = {knots.back()};
  for (std::size_t at = knots.size() - 1; at > 0; at = previous[at]) corners.push_back(knots[previous[at]]);
  std::reverse(corners.begin(), corners.end());
  return corners;
}

}  // namespace waretwin::generate
