#include "mapper/localise/scan_matcher.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/pose.h"

namespace waretwin {
namespace {

// Weak enough to leave no trace in what the lines determine, strong enough to hold what they do not.
constexpr double kPriorWeight = 1e-6;
constexpr int kFewestPairs = 10;
constexpr int kLargestGrid = 1 << 20;

// Line fitted to points [first, last] by total least squares. rms is the distance of the points from it.
struct FittedLine {
  ReferenceScan::Line line;
  double rms = std::numeric_limits<double>::infinity();
};

FittedLine fit_line(const std::vector<Eigen::Vector2d>& points, int first, int last) {
  FittedLine fitted;
  const int count = last - first + 1;
  if (count < 3) return fitted;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (int i = first; i <= last; ++i) mean += points[i];
  mean /= count;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (int i = first; i <= last; ++i) covariance += (points[i] - mean) * (points[i] - mean).transpose();
  covariance /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  const Eigen::Vector2d along = eigen.eigenvectors().col(1);
  fitted.line.on_line = mean;
  fitted.line.normal = {-along.y(), along.x()};
  for (int i = first; i <= last; ++i) fitted.line.reach = std::max(fitted.line.reach, std::abs(along.dot(points[i] - mean)));
  // Two parameters were fitted: without the correction short windows look better than they are.
  fitted.rms = std::sqrt(std::max(0.0, eigen.eigenvalues()[0]) * count / (count - 2));
  // A blob is no line.
  if (eigen.eigenvalues()[1] < 4.0 * eigen.eigenvalues()[0]) fitted.rms = std::numeric_limits<double>::infinity();
  return fitted;
}

ReferenceScan::Line line_at(const std::vector<Eigen::Vector2d>& points, int i, double radius) {
  // Beams fan out: a wall seen at a grazing angle has wide gaps, yet a step to another surface must not be bridged.
  const auto connected = [&](int a, int b) { return (points[a] - points[b]).norm() < std::max(0.1, 0.5 * radius); };
  int first = i, last = i;
  const int count = static_cast<int>(points.size());
  while (first > 0 && connected(first - 1, first) && (points[first - 1] - points[i]).norm() <= radius) --first;
  while (last + 1 < count && connected(last, last + 1) && (points[last + 1] - points[i]).norm() <= radius) ++last;
  // Near a corner the whole window bends; one of its halves does not.
  FittedLine best = fit_line(points, first, last);
  for (const FittedLine& half : {fit_line(points, first, i), fit_line(points, i, last)}) {
    // Half the points tell less: they must fit clearly better.
    if (half.rms < 0.6 * best.rms) best = half;
  }
  if (!std::isfinite(best.rms) || best.rms > 0.2 * radius + 1e-12) return {};
  return best.line;
}

// Root of the value at `order` among the residuals, squared.
double quantile(std::vector<double> values, double order) {
  const std::size_t at = std::min(values.size() - 1, static_cast<std::size_t>(order * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

struct Candidate {
  PointOnLine pair;
  double residual = 0.0;  // absolute distance from the line
};

// Censi's own line: through the nearest point and the nearer of its two neighbours along the scan.
ReferenceScan::Line two_point_line(const ReferenceScan& reference, int nearest, const Eigen::Vector2d& p) {
  const auto& points = reference.points();
  int second = -1;
  double best = std::numeric_limits<double>::infinity();
  for (const int i : {nearest - 1, nearest + 1}) {
    if (i < 0 || i >= static_cast<int>(points.size())) continue;
    const double distance = (points[i] - p).squaredNorm();
    if (distance < best && (points[i] - points[nearest]).squaredNorm() > 1e-12) {
      best = distance;
      second = i;
    }
  }
  ReferenceScan::Line line;
  if (second < 0) return line;
  const Eigen::Vector2d along = (points[second] - points[nearest]).normalized();
  line.on_line = points[nearest];
  line.normal = {-along.y(), along.x()};
  line.reach = std::numeric_limits<double>::infinity();
  return line;
}

std::vector<Candidate> correspondences(const ReferenceScan& reference, const std::vector<Eigen::Vector2d>& points_S,
                                       const PlanarMotion& X_RS, const ScanMatchConfig& config) {
  const bool two_points = config.lines == "two_points";
  const Eigen::Matrix2d R = X_RS.rotation();
  std::vector<Candidate> found;
  found.reserve(points_S.size());
  for (const Eigen::Vector2d& p_S : points_S) {
    const Eigen::Vector2d p_R = R * p_S + X_RS.translation;
    const int nearest = reference.nearest(p_R, config.max_correspondence_m);
    if (nearest < 0) continue;
    const ReferenceScan::Line line = two_points ? two_point_line(reference, nearest, p_R) : reference.lines()[nearest];
    if (line.normal.isZero()) continue;
    const Eigen::Vector2d offset = p_R - line.on_line;
    const double along = std::abs(line.normal.x() * offset.y() - line.normal.y() * offset.x());
    // Beyond the end of its line a point sees a surface that the reference scan did not.
    if (along > line.reach + 0.05) continue;
    found.push_back({{p_S, line.on_line, line.normal}, std::abs(line.normal.dot(offset))});
  }
  return found;
}

// Censi 2008, section IV: a fixed share goes, and what is far beyond the residual at a quantile goes too.
std::vector<PointOnLine> trimmed(const std::vector<Candidate>& candidates, const ScanMatchConfig& config, double& rms) {
  std::vector<double> residuals;
  residuals.reserve(candidates.size());
  for (const Candidate& c : candidates) residuals.push_back(c.residual);
  double limit = quantile(residuals, config.keep_fraction);
  // A floor keeps a noise-free scan from trimming itself away.
  limit = std::min(limit, std::max(1e-6, config.adaptive_factor * quantile(residuals, config.adaptive_order)));
  std::vector<PointOnLine> pairs;
  double sum = 0.0;
  for (const Candidate& c : candidates) {
    if (c.residual > limit) continue;
    pairs.push_back(c.pair);
    sum += c.residual * c.residual;
  }
  rms = pairs.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(pairs.size()));
  return pairs;
}

}  // namespace

ReferenceScan::ReferenceScan(std::vector<Eigen::Vector2d> points, const ScanMatchConfig& config) : points_(std::move(points)) {
  const int count = static_cast<int>(points_.size());
  lines_.reserve(points_.size());
  for (int i = 0; i < count; ++i) lines_.push_back(line_at(points_, i, config.line_radius_m));
  if (points_.empty()) return;
  Eigen::Vector2d low = points_.front(), high = points_.front();
  for (const Eigen::Vector2d& p : points_) {
    WARETWIN_CHECK(p.allFinite(), "scan points are finite");
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  cell_ = std::max(0.05, 0.5 * config.max_correspondence_m);
  while ((high.x() - low.x()) / cell_ * ((high.y() - low.y()) / cell_) > kLargestGrid) cell_ *= 2.0;
  origin_ = low;
  columns_ = static_cast<int>((high.x() - low.x()) / cell_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / cell_) + 1;
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    return static_cast<int>((p.y() - origin_.y()) / cell_) * columns_ + static_cast<int>((p.x() - origin_.x()) / cell_);
  };
  cell_start_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  for (const Eigen::Vector2d& p : points_) ++cell_start_[cell_of(p) + 1];
  for (std::size_t i = 1; i < cell_start_.size(); ++i) cell_start_[i] += cell_start_[i - 1];
  cell_points_.resize(points_.size());
  std::vector<int> next(cell_start_.begin(), cell_start_.end() - 1);
  for (int i = 0; i < count; ++i) cell_points_[next[cell_of(points_[i])]++] = i;
}

int ReferenceScan::nearest(const Eigen::Vector2d& p, double max_distance) const {
  if (points_.empty()) return -1;
  const double x = std::floor((p.x() - origin_.x()) / cell_), y = std::floor((p.y() - origin_.y()) / cell_);
  const int rings = static_cast<int>(std::ceil(max_distance / cell_));
  if (x < -rings || y < -rings || x >= columns_ + rings || y >= rows_ + rings) return -1;
  const int cx = static_cast<int>(x), cy = static_cast<int>(y);
  int best = -1;
  double best_squared = max_distance * max_distance;
  for (int ring = 0; ring <= rings; ++ring) {
    // Everything in ring k lies at least (k - 1) cells away.
    const double least = (ring - 1) * cell_;
    if (best >= 0 && least > 0.0 && least * least > best_squared) break;
    for (int row = std::max(0, cy - ring); row <= std::min(rows_ - 1, cy + ring); ++row) {
      const bool edge = row == cy - ring || row == cy + ring;
      for (int column = cx - ring; column <= cx + ring; column += edge || ring == 0 ? 1 : 2 * ring) {
        if (column < 0 || column >= columns_) continue;
        const int cell = row * columns_ + column;
        for (int k = cell_start_[cell]; k < cell_start_[cell + 1]; ++k) {
          const int i = cell_points_[k];
          const double squared = (points_[i] - p).squaredNorm();
          if (squared < best_squared || (squared == best_squared && (best < 0 || i < best))) {
            best = i;
            best_squared = squared;
          }
        }
      }
    }
  }
  return best;
}

ScanMatch match_scans(const ReferenceScan& reference, const std::vector<Eigen::Vector2d>& points_S, const PlanarMotion& guess,
                      const ScanMatchConfig& config) {
  ScanMatch match;
  match.X_RS = guess;
  const double rotation_epsilon = to_radians(config.rotation_epsilon_deg);
  const auto reject = [&] {
    match.X_RS = guess;
    match.converged = false;
    return match;
  };
  std::vector<PlanarMotion> visited;
  for (match.iterations = 0; match.iterations < config.max_iterations && !match.converged;) {
    const std::vector<Candidate> candidates = correspondences(reference, points_S, match.X_RS, config);
    if (candidates.size() < kFewestPairs) return reject();
    double rms = 0.0;
    const std::vector<PointOnLine> pairs = trimmed(candidates, config, rms);
    if (pairs.size() < kFewestPairs) return reject();
    const PointToLineSolution solution = solve_point_to_line(pairs, match.X_RS, kPriorWeight);
    const PlanarMotion step = match.X_RS.inverse() * solution.motion;
    match.X_RS = solution.motion;
    match.translation_information = solution.translation_information;
    ++match.iterations;
    const auto small = [&](const PlanarMotion& motion) {
      return motion.translation.norm() <= config.translation_epsilon_m && std::abs(motion.yaw) <= rotation_epsilon;
    };
    // Correspondences of noisy scans may alternate between a few sets for ever: back where it once was, the search has ended too.
    match.converged = small(step) || std::any_of(visited.begin(), visited.end(),
                                                 [&](const PlanarMotion& earlier) { return small(earlier.inverse() * match.X_RS); });
    visited.push_back(match.X_RS);
  }
  const std::vector<Candidate> candidates = correspondences(reference, points_S, match.X_RS, config);
  if (candidates.size() < kFewestPairs) return reject();
  const std::vector<PointOnLine> pairs = trimmed(candidates, config, match.residual_m);
  match.matched_fraction = static_cast<double>(pairs.size()) / static_cast<double>(points_S.size());
  match.believable = match.matched_fraction >= config.min_matched_fraction && match.residual_m <= config.max_residual_m;
  return match;
}

}  // namespace waretwin
