#include "harness/calibrate/scan_lines.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "core/statistics.h"

namespace waretwin {

namespace {

// Nothing where they are not straight.
std::optional<ScanLine> line_through(std::vector<LaserPoint> points) {
  constexpr double kStraight_m = 0.02;
  ScanLine line;
  const auto count = static_cast<double>(points.size());
  for (const LaserPoint& point : points) line.middle_L += point.p_L().head<2>() / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const LaserPoint& point : points) {
    const Eigen::Vector2d off = point.p_L().head<2>() - line.middle_L;
    scatter += off * off.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
  if (eigen.eigenvalues()[0] > kStraight_m * kStraight_m) return std::nullopt;
  line.direction_L = eigen.eigenvectors().col(1);
  double least = 0.0, most = 0.0;
  for (const LaserPoint& point : points) {
    const double along = line.direction_L.dot(point.p_L().head<2>() - line.middle_L);
    least = std::min(least, along);
    most = std::max(most, along);
  }
  line.length_m = most - least;
  line.points = std::move(points);
  return line;
}

}  // namespace

bool steady(const BeamMean& beam, int scans) { return beam.readings > 0 && 2 * beam.readings >= scans; }

std::vector<LaserPoint> laser_points(const std::vector<BeamMean>& beams) {
  std::vector<double> sigmas;
  for (const BeamMean& beam : beams) {
    if (beam.readings > 2) sigmas.push_back(beam.sigma_m);
  }
  // Too few scans to tell, or readings that never change: a step of 10 mm hides about 3 mm.
  constexpr double kStep = 0.003;
  const double sigma = sigmas.empty() ? 0.01 : std::max(kStep, median(std::move(sigmas)));
  std::vector<LaserPoint> points;
  for (const BeamMean& beam : beams) points.push_back({beam.angle, beam.range_m, sigma / std::sqrt(static_cast<double>(beam.readings))});
  return points;
}

std::vector<ScanLine> scan_lines(const StillPose& pose) {
  constexpr std::size_t kEnds = 2;
  const std::vector<BeamMean>& beams = pose.beams;
  std::vector<ScanLine> lines;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= beams.size(); ++i) {
    const bool joined = i > begin && i < beams.size() && steady(beams[i], pose.scans) && steady(beams[i - 1], pose.scans) &&
                        std::abs(beams[i].range_m - beams[i - 1].range_m) < 0.05 + 0.02 * beams[i].range_m;
    if (joined) continue;
    if (i - begin >= static_cast<std::size_t>(kLeastPoints) + 2 * kEnds) {
      const auto from = beams.begin() + static_cast<std::ptrdiff_t>(begin), to = beams.begin() + static_cast<std::ptrdiff_t>(i);
      std::vector<LaserPoint> points = laser_points({from, to});
      points.erase(points.end() - kEnds, points.end());
      points.erase(points.begin(), points.begin() + kEnds);
      if (std::optional<ScanLine> line = line_through(std::move(points))) lines.push_back(*std::move(line));
    }
    begin = i;
  }
  return lines;
}

}  // namespace waretwin
