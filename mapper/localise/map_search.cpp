#include "mapper/localise/map_search.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "core/pose.h"

namespace waretwin {
namespace {

constexpr int kLevels = 6;  // boxes of up to 32 cells
constexpr double kMostCells = 1 << 23;

// Values of the cells around the map's points; level k holds the largest value of the 2^k x 2^k cells from each one on.
class Pyramid {
 public:
  Pyramid(const LocalMap& map, const Eigen::Vector2d& low, const Eigen::Vector2d& high, const MapSearchConfig& config) {
    cell_ = config.cell_m;
    while ((high.x() - low.x()) / cell_ * ((high.y() - low.y()) / cell_) > kMostCells) cell_ *= 2.0;
    origin_ = low;
    columns_ = static_cast<int>((high.x() - low.x()) / cell_) + 1;
    rows_ = static_cast<int>((high.y() - low.y()) / cell_) + 1;
    levels_.emplace_back(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), std::uint8_t{0});
    const int reach = static_cast<int>(std::ceil(3.0 * config.blur_m / cell_));
    for (const MapPoint& point : map.points()) {
      const Eigen::Vector2d at = (point.p - origin_) / cell_;
      const int cx = static_cast<int>(std::floor(at.x())), cy = static_cast<int>(std::floor(at.y()));
      for (int y = std::max(0, cy - reach); y <= std::min(rows_ - 1, cy + reach); ++y) {
        for (int x = std::max(0, cx - reach); x <= std::min(columns_ - 1, cx + reach); ++x) {
          const double distance = cell_ * std::hypot(x + 0.5 - at.x(), y + 0.5 - at.y());
          const double ratio = distance / config.blur_m;
          auto& value = levels_[0][index(x, y)];
          value = std::max(value, static_cast<std::uint8_t>(std::lround(255.0 / (1.0 + ratio * ratio))));
        }
      }
    }
    for (int level = 1; level < kLevels; ++level) {
      const int half = 1 << (level - 1);
      const std::vector<std::uint8_t>& below = levels_.back();
      std::vector<std::uint8_t> values(below.size());
      for (int y = 0; y < rows_; ++y) {
        for (int x = 0; x < columns_; ++x) {
          const int x2 = std::min(x + half, columns_ - 1), y2 = std::min(y + half, rows_ - 1);
          values[index(x, y)] = std::max({below[index(x, y)], below[index(x2, y)], below[index(x, y2)], below[index(x2, y2)]});
        }
      }
      levels_.push_back(std::move(values));
    }
  }

  double cell() const { return cell_; }
  Eigen::Vector2i cell_at(const Eigen::Vector2d& p) const {
    return {static_cast<int>(std::floor((p.x() - origin_.x()) / cell_)), static_cast<int>(std::floor((p.y() - origin_.y()) / cell_))};
  }
  // Largest value in the box of 2^level cells from (x, y) on; cells outside hold nothing.
  int value(int level, int x, int y) const {
    const int size = 1 << level;
    if (x >= columns_ || y >= rows_ || x + size <= 0 || y + size <= 0) return 0;
    // A box that begins outside is covered by the one at the border.
    return levels_[static_cast<std::size_t>(level)][index(std::max(x, 0), std::max(y, 0))];
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  }
  double cell_ = 0.05;
  Eigen::Vector2d origin_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint8_t>> levels_;
};

struct Node {
  int sum = 0;  // upper bound of the points' values
  int level = 0;
  int turn = 0;                              // index of the heading
  int x = 0, y = 0;                          // cells from the window's corner
  bool operator<(const Node& other) const {  // the queue hands out the largest; ties in a fixed order
    if (sum != other.sum) return sum < other.sum;
    if (level != other.level) return level > other.level;
    if (turn != other.turn) return turn > other.turn;
    if (y != other.y) return y > other.y;
    return x > other.x;
  }
};

}  // namespace

double pose_score(const LocalMap& map, const std::vector<ScanPoint>& points_B, const PlanarMotion& X_SB, double bias,
                  const MapSearchConfig& config) {
  if (points_B.empty()) return 0.0;
  const Eigen::Matrix2d R = X_SB.rotation();
  const double reach = 3.0 * config.blur_m;
  double sum = 0.0;
  for (const ScanPoint& point : points_B) {
    const Eigen::Vector2d p_S = R * (point.p - bias * point.direction) + X_SB.translation;
    const int nearest = map.nearest(p_S, R * point.normal, reach, 0.5);
    if (nearest < 0) continue;
    const double ratio = (map.points()[static_cast<std::size_t>(nearest)].p - p_S).norm() / config.blur_m;
    sum += 1.0 / (1.0 + ratio * ratio);
  }
  return sum / static_cast<double>(points_B.size());
}

std::optional<SearchResult> search_map(const LocalMap& map, const std::vector<ScanPoint>& points_B, const SearchWindow& window, double bias,
                                       const MapSearchConfig& config) {
  if (map.points().empty() || points_B.empty()) return std::nullopt;
  // Points spread evenly over the scan.
  const std::size_t wanted = std::min(points_B.size(), static_cast<std::size_t>(config.points));
  std::vector<Eigen::Vector2d> chosen_B;
  double farthest = 0.0;
  for (std::size_t k = 0; k < wanted; ++k) {
    const ScanPoint& point = points_B[k * points_B.size() / wanted];
    chosen_B.push_back(point.p - bias * point.direction);
    farthest = std::max(farthest, chosen_B.back().norm());
  }
  // Only the part of the map that the scan can meet.
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(window.half_m + farthest + 1.0);
  Eigen::Vector2d low = map.points().front().p, high = low;
  for (const MapPoint& point : map.points()) {
    low = low.cwiseMin(point.p);
    high = high.cwiseMax(point.p);
  }
  const Eigen::Vector2d edge = Eigen::Vector2d::Constant(3.0 * config.blur_m);
  low = (low - edge).cwiseMax(window.centre.translation - margin);
  high = (high + edge).cwiseMin(window.centre.translation + margin);
  if (!(low.x() < high.x()) || !(low.y() < high.y())) return std::nullopt;
  const Pyramid pyramid(map, low, high, config);

  // A turn that moves the farthest point by a cell; points beyond 10 m are few and may move more.
  const double turn_step = pyramid.cell() / std::clamp(farthest, 1.0, 10.0);
  const int turns = static_cast<int>(std::ceil(to_radians(window.half_deg) / turn_step));
  const int side = 2 * static_cast<int>(std::ceil(window.half_m / pyramid.cell())) + 1;
  std::vector<std::vector<Eigen::Vector2i>> cells(static_cast<std::size_t>(2 * turns + 1));
  const Eigen::Vector2d corner = window.centre.translation - Eigen::Vector2d::Constant((side / 2) * pyramid.cell());
  for (int turn = -turns; turn <= turns; ++turn) {
    const Eigen::Matrix2d R = PlanarMotion{{0, 0}, window.centre.yaw + turn * turn_step}.rotation();
    std::vector<Eigen::Vector2i>& list = cells[static_cast<std::size_t>(turn + turns)];
    list.reserve(chosen_B.size());
    for (const Eigen::Vector2d& p_B : chosen_B) list.push_back(pyramid.cell_at(R * p_B + corner));
  }
  const auto bounded = [&](Node node) {
    node.sum = 0;
    for (const Eigen::Vector2i& cell : cells[static_cast<std::size_t>(node.turn)]) {
      node.sum += pyramid.value(node.level, cell.x() + node.x, cell.y() + node.y);
    }
    return node;
  };
  const int least = static_cast<int>(std::ceil(config.min_score * 255.0 * static_cast<double>(wanted)));
  std::priority_queue<Node> open;
  const int top = kLevels - 1, size = 1 << top;
  for (int turn = 0; turn < 2 * turns + 1; ++turn) {
    for (int y = 0; y < side; y += size) {
      for (int x = 0; x < side; x += size) {
        const Node node = bounded({0, top, turn, x, y});
        if (node.sum >= least) open.push(node);
      }
    }
  }
  while (!open.empty()) {
    const Node node = open.top();
    open.pop();
    if (node.level == 0) {
      // No other node can hold more: this is the best.
      SearchResult result;
      result.X_SB.translation = corner + pyramid.cell() * Eigen::Vector2d(node.x, node.y);
      result.X_SB.yaw = wrap_angle(window.centre.yaw + (node.turn - turns) * turn_step);
      result.score = node.sum / (255.0 * static_cast<double>(wanted));
      return result;
    }
    const int half = 1 << (node.level - 1);
    for (const int dy : {0, half}) {
      for (const int dx : {0, half}) {
        if (node.x + dx >= side || node.y + dy >= side) continue;
        const Node child = bounded({0, node.level - 1, node.turn, node.x + dx, node.y + dy});
        if (child.sum >= least) open.push(child);
      }
    }
  }
  return std::nullopt;
}

}  // namespace waretwin
