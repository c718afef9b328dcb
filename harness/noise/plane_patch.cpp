#include "harness/noise/plane_patch.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/pose.h"
#include "core/statistics.h"

namespace waretwin {

namespace {

constexpr double kRounding = 1e-6 / 12.0;  // variance of whole millimetres, m^2

struct Reading {
  Eigen::Vector3d ray;  // (x, y, 1)
  double z;
  int u, v;  // in the patch
};

// Least-squares solution of sum w (row . x - y)^2.
struct Normal {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int count = 0;
  void add(const Eigen::Vector3d& row, double y) {
    A += row * row.transpose();
    b += row * y;
    ++count;
  }
  void add(const Normal& other) {
    A += other.A;
    b += other.b;
    count += other.count;
  }
  Normal without(const Normal& part) const { return {A - part.A, b - part.b, count - part.count}; }
  // What the solution takes away from the squares of y. A strip of one row determines no slope across it and gets none.
  double explained() const {
    const Eigen::Matrix3d ridged = A + 1e-9 * count * Eigen::Matrix3d::Identity();
    return b.dot(ridged.inverse() * b);
  }
  Eigen::Vector3d solve() const { return A.ldlt().solve(b); }
};

// The plane as n with n . ray = 1 / z. Rays are taken relative to their middle, which keeps the system well conditioned.
Eigen::Vector3d fit_plane(const std::vector<Reading>& readings, const Eigen::Vector3d& middle) {
  const auto centred = [&](const Reading& r) { return Eigen::Vector3d(r.ray.x() - middle.x(), r.ray.y() - middle.y(), 1.0); };
  // Weighted by z^2, an error of the inverse depth is one of the depth. First the readings serve as weights, then the plane does.
  Normal first;
  for (const Reading& r : readings) first.add(r.z * r.z * centred(r), r.z);
  Eigen::Vector3d n = first.solve();
  for (int pass = 0; pass < 2; ++pass) {
    Normal next;
    for (const Reading& r : readings) {
      const double z = 1.0 / n.dot(centred(r));
      next.add(z * z * centred(r), z - r.z);
    }
    n += next.solve();
  }
  n.z() -= n.x() * middle.x() + n.y() * middle.y();
  return n;
}

double residual(const Reading& reading, const Eigen::Vector3d& n) { return reading.z - 1.0 / n.dot(reading.ray); }

// Whether a reading lies far off the plane that most of the others agree upon: the one with the least sum of absolute residuals, which an
// edge at the border of the patch does not tilt. `n`: the least-squares plane, to start from.
bool has_outliers(const std::vector<Reading>& readings, const Eigen::Vector3d& middle, Eigen::Vector3d n, double most_sigmas) {
  constexpr double kStep = 0.001;  // of the readings; where all are the same millimetre the median residual is 0
  constexpr int kPasses = 6;
  for (int pass = 0; pass < kPasses; ++pass) {
    Normal next;
    for (const Reading& r : readings) {
      const double z = 1.0 / n.dot(r.ray), off = r.z - z;
      const double weight = 1.0 / std::sqrt(std::max(std::abs(off), 0.1 * kStep));
      next.add(weight * z * z * Eigen::Vector3d(r.ray.x() - middle.x(), r.ray.y() - middle.y(), 1.0), -weight * off);
    }
    const Eigen::Vector3d step = next.solve();
    n += Eigen::Vector3d(step.x(), step.y(), step.z() - step.x() * middle.x() - step.y() * middle.y());
  }
  std::vector<double> residuals;
  residuals.reserve(readings.size());
  for (const Reading& r : readings) residuals.push_back(std::abs(residual(r, n)));
  const double largest = *std::max_element(residuals.begin(), residuals.end());
  const double deviation = 1.4826 * median(std::move(residuals));
  return !(largest <= most_sigmas * std::max(deviation, 0.5 * kStep));
}

// PlanePatch::structure. Lines run along rows, columns and both diagonals.
double structure_share(const std::vector<Reading>& readings, const std::vector<double>& residuals, int side) {
  constexpr int kLeast = 9;  // readings on either side
  constexpr int kDirections[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  double before = 0.0, explained = 0.0;
  for (const double r : residuals) before += r * r;
  std::vector<Normal> strips;
  for (const auto& [across_u, across_v] : kDirections) {
    strips.assign(static_cast<std::size_t>(2 * side), {});
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const Reading& r = readings[i];
      const int strip = across_u * r.u + across_v * r.v + (across_v < 0 ? side : 0);
      // Over a patch, depth is as good as linear in the pixel.
      strips[static_cast<std::size_t>(strip)].add({(r.u + 0.5) / side - 0.5, (r.v + 0.5) / side - 0.5, 1.0}, residuals[i]);
    }
    Normal all, near;
    for (const Normal& strip : strips) all.add(strip);
    for (const Normal& strip : strips) {
      near.add(strip);
      const Normal far = all.without(near);
      if (near.count < kLeast || far.count < kLeast) continue;
      explained = std::max(explained, near.explained() + far.explained());
    }
  }
  // Rounding alone has a pattern, too.
  return explained / std::max(before, static_cast<double>(readings.size()) * kRounding);
}

double neighbour_correlation(const std::vector<Reading>& readings, const std::vector<double>& residuals, double variance) {
  double sum = 0.0;
  int pairs = 0;
  // Readings stand in order of rows.
  for (std::size_t i = 1; i < readings.size(); ++i) {
    if (readings[i].v != readings[i - 1].v || readings[i].u != readings[i - 1].u + 1) continue;
    sum += residuals[i] * residuals[i - 1];
    ++pairs;
  }
  return pairs > 0 && variance > 0.0 ? sum / (pairs * variance) : 0.0;
}

}  // namespace

PlanePatch measure_patch(const cv::Mat& depth, const cv::Mat& rays, const cv::Rect& area, const NoiseConfig& config) {
  WARETWIN_CHECK(area.width == area.height, "patches are squares");
  WARETWIN_CHECK(depth.type() == CV_32FC1 && rays.type() == CV_32FC3 && depth.size() == rays.size(), "a depth image and its rays");
  PlanePatch patch;
  patch.pixels = area.area();
  std::vector<Reading> readings;
  readings.reserve(static_cast<std::size_t>(area.area()));
  double ranges = 0.0, depths = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int v = 0; v < area.height; ++v) {
    const auto* z = depth.ptr<float>(area.y + v) + area.x;
    const auto* ray = rays.ptr<cv::Vec3f>(area.y + v) + area.x;
    for (int u = 0; u < area.width; ++u) {
      if (z[u] == 0.0f || ray[u][2] == 0.0f) continue;
      const Eigen::Vector3d direction = Eigen::Vector3f(ray[u][0], ray[u][1], 1.0f).cast<double>();
      readings.push_back({direction, static_cast<double>(z[u]), u, v});
      ranges += direction.norm() * readings.back().z;
      depths += readings.back().z;
      middle += direction;
    }
  }
  patch.readings = static_cast<int>(readings.size());
  if (readings.empty()) return patch;
  const auto count = static_cast<double>(readings.size());
  patch.range_m = ranges / count;
  patch.depth_m = depths / count;
  if (patch.readings < std::max(12.0, config.min_valid_share * patch.pixels)) return patch;
  middle /= count;

  const Eigen::Vector3d n = fit_plane(readings, middle);
  patch.verdict = PatchVerdict::kStructured;
  if (!n.allFinite()) return patch;
  patch.cosine = n.dot(middle) / (n.norm() * middle.norm());
  std::vector<double> residuals;
  double squares_z = 0.0, squares_r = 0.0, squared_lengths = 0.0;
  for (const Reading& r : readings) {
    const double inverse = n.dot(r.ray);
    if (!(inverse > 0.0)) return patch;  // the plane runs through the lens
    residuals.push_back(residual(r, n));
    const double square = residuals.back() * residuals.back(), length = r.ray.squaredNorm();
    squares_z += square;
    squares_r += square * length;
    squared_lengths += length;
  }
  if (has_outliers(readings, middle, n, config.max_outlier_sigmas)) return patch;
  patch.verdict = PatchVerdict::kGrazing;
  if (patch.cosine < std::cos(to_radians(config.max_incidence_deg))) return patch;
  patch.verdict = PatchVerdict::kPlane;
  patch.structure = structure_share(readings, residuals, area.width);
  const double freedom = count - 3.0;
  patch.correlation = neighbour_correlation(readings, residuals, squares_z / freedom);
  patch.variance_z = squares_z / freedom - kRounding;
  patch.variance_r = squares_r / freedom - kRounding * squared_lengths / count;
  return patch;
}

double structure_limit(int readings, double correlation, const NoiseConfig& config) {
  // Errors that hang together more than this are no errors of readings any more.
  const double c = std::clamp(correlation, 0.0, 0.7), root = (1.0 - c) / (1.0 + c);
  const double independent = readings * root * root;
  return config.max_structure / (independent + config.max_structure);
}

}  // namespace waretwin
