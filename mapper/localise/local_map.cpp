#include "mapper/localise/local_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace waretwin {
namespace {

constexpr double kLargestGrid = 1 << 21;

std::uint64_t key_of(const Eigen::Vector2d& p, const Eigen::Vector2d& normal, double cell_m) {
  const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(p.x() / cell_m)));
  const auto y = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(p.y() / cell_m)));
  const double turn = (std::atan2(normal.y(), normal.x()) / std::numbers::pi + 1.0) * 4.0;
  const auto eighth = static_cast<std::uint64_t>(std::clamp(std::floor(turn), 0.0, 7.0));
  // 30 bits for each coordinate: with cells of 5 mm a hall of 2,000 km.
  return (eighth << 60) | ((static_cast<std::uint64_t>(x) & 0x3fffffff) << 30) | (static_cast<std::uint64_t>(y) & 0x3fffffff);
}

}  // namespace

void LocalMap::add(const std::vector<ScanPoint>& points_K, const PlanarMotion& X_SK, double bias, int keyframe) {
  const Eigen::Matrix2d R = X_SK.rotation();
  for (const ScanPoint& point : points_K) {
    const Eigen::Vector2d p = R * (point.p - bias * point.direction) + X_SK.translation;
    const Eigen::Vector2d normal = R * point.normal;
    const auto [at, is_new] = index_.try_emplace(key_of(p, normal, cell_m_), static_cast<int>(sums_.size()));
    if (is_new) {
      sums_.emplace_back();
      sums_.back().first_seen = keyframe;
    }
    MapPoint& sum = sums_[static_cast<std::size_t>(at->second)];
    sum.first_seen = std::min(sum.first_seen, keyframe);
    sum.p += p;
    sum.direction += R * point.direction;
    sum.normal += normal;
    sum.count += 1.0;
  }
}

void LocalMap::finish() {
  points_ = sums_;
  double all = 0.0;
  for (MapPoint& point : points_) {
    point.p /= point.count;
    point.direction /= point.count;
    point.normal.normalize();
    all += point.count;
  }
  mean_count_ = points_.empty() ? 1.0 : all / static_cast<double>(points_.size());
  ordered_.clear();
  cell_start_.clear();
  columns_ = rows_ = 0;
  if (points_.empty()) return;
  Eigen::Vector2d low = points_.front().p, high = low;
  for (const MapPoint& point : points_) {
    WARETWIN_CHECK(point.p.allFinite(), "map points are finite");
    low = low.cwiseMin(point.p);
    high = high.cwiseMax(point.p);
  }
  grid_m_ = std::max(0.1, 2.0 * cell_m_);
  while ((high.x() - low.x()) / grid_m_ * ((high.y() - low.y()) / grid_m_) > kLargestGrid) grid_m_ *= 2.0;
  origin_ = low;
  columns_ = static_cast<int>((high.x() - low.x()) / grid_m_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / grid_m_) + 1;
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    return static_cast<std::size_t>((p.y() - origin_.y()) / grid_m_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>((p.x() - origin_.x()) / grid_m_);
  };
  cell_start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const MapPoint& point : points_) ++cell_start_[cell_of(point.p) + 1];
  for (std::size_t i = 1; i < cell_start_.size(); ++i) cell_start_[i] += cell_start_[i - 1];
  ordered_.resize(points_.size());
  std::vector<int> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    ordered_[static_cast<std::size_t>(next[cell_of(points_[i].p)]++)] = {points_[i].p, points_[i].normal, static_cast<int>(i)};
  }
}

int LocalMap::nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal, double max_distance, double min_cosine) const {
  if (points_.empty()) return -1;
  const Eigen::Vector2d at = (p - origin_) / grid_m_;
  const double reach = max_distance / grid_m_;
  const double x0 = std::max(0.0, std::floor(at.x() - reach)), x1 = std::min(columns_ - 1.0, std::floor(at.x() + reach));
  const double y0 = std::max(0.0, std::floor(at.y() - reach)), y1 = std::min(rows_ - 1.0, std::floor(at.y() + reach));
  if (!(x0 <= x1) || !(y0 <= y1)) return -1;
  int best = -1;
  double best_squared = max_distance * max_distance;
  for (int row = static_cast<int>(y0); row <= static_cast<int>(y1); ++row) {
    // Cells of one row lie side by side in memory.
    const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
    const int end = cell_start_[start + static_cast<std::size_t>(x1) + 1];
    for (int k = cell_start_[start + static_cast<std::size_t>(x0)]; k < end; ++k) {
      const Entry& entry = ordered_[static_cast<std::size_t>(k)];
      const double squared = (entry.p - p).squaredNorm();
      if (squared > best_squared || (squared == best_squared && best >= 0 && entry.index > best)) continue;
      if (entry.normal.dot(normal) < min_cosine) continue;
      best = entry.index;
      best_squared = squared;
    }
  }
  return best;
}

}  // namespace waretwin
