#include "mapper/localise/scan_points.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace waretwin {
namespace {

struct Line {
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double rms = std::numeric_limits<double>::infinity();
};

// Sums over the points before each, so that a line over any window costs the same.
class Moments {
 public:
  explicit Moments(const std::vector<ScanPoint>& points) : sums_(points.size() + 1, Row{}) {
    if (points.empty()) return;
    origin_ = points.front().p;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d q = points[i].p - origin_;
      sums_[i + 1] = {sums_[i].x + q.x(), sums_[i].y + q.y(), sums_[i].xx + q.x() * q.x(), sums_[i].xy + q.x() * q.y(),
                      sums_[i].yy + q.y() * q.y()};
    }
  }

  // Total least squares over points [first, last].
  Line line(int first, int last) const {
    Line fitted;
    const int count = last - first + 1;
    if (count < 4) return fitted;
    const Row& a = sums_[static_cast<std::size_t>(first)];
    const Row& b = sums_[static_cast<std::size_t>(last) + 1];
    const double n = count, mx = (b.x - a.x) / n, my = (b.y - a.y) / n;
    const double xx = (b.xx - a.xx) / n - mx * mx, xy = (b.xy - a.xy) / n - mx * my, yy = (b.yy - a.yy) / n - my * my;
    const double half_trace = 0.5 * (xx + yy), root = std::hypot(0.5 * (xx - yy), xy);
    const double large = half_trace + root, small = std::max(0.0, half_trace - root);
    // A blob is no line.
    if (large < 4.0 * small) return fitted;
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    fitted.along = {std::cos(angle), std::sin(angle)};
    // Two parameters were fitted: without the correction short windows look better than they are.
    fitted.rms = std::sqrt(small * n / (n - 2.0));
    return fitted;
  }

 private:
  struct Row {
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };
  std::vector<Row> sums_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
};

}  // namespace

std::vector<ScanPoint> scan_points(const LaserScan& scan, const Pose& X_BL, const PlanarMotion& to_first, const PlanarMotion& to_last,
                                   const ScanPointsConfig& config) {
  const std::size_t beams = scan.ranges.size();
  std::vector<ScanPoint> points;
  std::vector<int> beam_of;
  std::vector<double> range_of;
  points.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const double range = scan.ranges[i];
    if (!(range > config.min_range_m) || !(range < scan.range_max) || range < scan.range_min) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector3d d_L(std::cos(angle), std::sin(angle), 0.0);
    ScanPoint point;
    point.p = (X_BL * (range * d_L)).head<2>();
    point.direction = (X_BL.linear() * d_L).head<2>().normalized();
    if (config.deskew && beams > 1) {
      const double t = 2.0 * static_cast<double>(i) / static_cast<double>(beams - 1) - 1.0;
      const PlanarMotion& towards = t < 0.0 ? to_first : to_last;
      const PlanarMotion moved{std::abs(t) * towards.translation, std::abs(t) * towards.yaw};
      const Eigen::Matrix2d R = moved.rotation();
      point.p = R * point.p + moved.translation;
      point.direction = R * point.direction;
    }
    points.push_back(point);
    beam_of.push_back(static_cast<int>(i));
    range_of.push_back(range);
  }
  const int count = static_cast<int>(points.size());
  // Whether points i and i + 1 lie on one surface.
  std::vector<char> joined(points.size(), 0);
  for (int i = 0; i + 1 < count; ++i) {
    const double width = std::min(range_of[i], range_of[i + 1]) * std::abs(scan.angle_increment) * (beam_of[i + 1] - beam_of[i]);
    joined[i] = (points[i + 1].p - points[i].p).norm() < std::max(config.edge_gap_m, config.edge_slope * width);
  }
  const Moments moments(points);
  std::vector<ScanPoint> kept;
  kept.reserve(points.size());
  const double reach = config.line_radius_m * config.line_radius_m;
  for (int i = 1; i + 1 < count; ++i) {
    if (!joined[i - 1] || !joined[i]) continue;
    int first = i, last = i;
    while (first > 0 && joined[first - 1] && (points[first - 1].p - points[i].p).squaredNorm() <= reach) --first;
    while (last + 1 < count && joined[last] && (points[last + 1].p - points[i].p).squaredNorm() <= reach) ++last;
    // Far away, beams lie wide apart: a few neighbours whatever the distance.
    while (i - first < 2 && first > 0 && joined[first - 1]) --first;
    while (last - i < 2 && last + 1 < count && joined[last]) ++last;
    Line best = moments.line(first, last);
    // Near a corner the whole window bends; one of its halves does not. Half the points tell less: they must fit clearly better.
    for (const Line& half : {moments.line(first, i), moments.line(i, last)}) {
      if (half.rms < 0.6 * best.rms) best = half;
    }
    if (!(best.rms <= config.max_line_rms_m)) continue;
    ScanPoint point = points[i];
    point.normal = {-best.along.y(), best.along.x()};
    if (point.normal.dot(point.direction) > 0.0) point.normal = -point.normal;
    kept.push_back(point);
  }
  return kept;
}

}  // namespace waretwin
