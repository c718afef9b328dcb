#include "harness/calibrate/board_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace waretwin {

namespace {

// Of a spot at a range: half of 8 mm + 15 mrad (sensors/laser_config.h), which is about what safety scanners have, and room for corners'
// errors.
double beside(double range_m) { return 0.01 + 0.0075 * range_m; }

}  // namespace

void GuessGate::visit(Fields& f) {
  f("distance_m", distance_m, "how far around the known place a board's line is looked for first", {.min = 0, .max = 5});
  f("angle_deg", angle_deg, "how far turned from the known direction", {.min = 0, .max = 45});
}

std::optional<BoardView> view_board(const std::vector<Eigen::Vector2d>& corners, const Intrinsics& intrinsics, const CheckerBoard& board) {
  std::vector<cv::Point3d> corners_O;
  for (const Eigen::Vector3d& p : board.corners_O()) corners_O.emplace_back(p.x(), p.y(), p.z());
  std::vector<cv::Point2d> pixels;
  for (const Eigen::Vector2d& p : corners) pixels.emplace_back(p.x(), p.y());
  const cv::Matx33d k(intrinsics.fx, 0, intrinsics.cx, 0, intrinsics.fy, intrinsics.cy, 0, 0, 1);
  // A flat board has two poses that look much alike; the better one is refined.
  std::vector<cv::Mat> turns, shifts;
  cv::solvePnPGeneric(corners_O, pixels, k, cv::noArray(), turns, shifts, false, cv::SOLVEPNP_IPPE);
  if (turns.empty()) return std::nullopt;
  cv::Mat turn = turns[0], shift = shifts[0];
  cv::solvePnPRefineLM(corners_O, pixels, k, cv::noArray(), turn, shift, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12});
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  BoardView view;
  view.corners = corners;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) view.X_CO.linear()(r, c) = rotation(r, c);
    view.X_CO.translation()[r] = shift.at<double>(r);
  }
  if (!view.X_CO.matrix().allFinite() || view.distance_m() <= 0.0) return std::nullopt;
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d p_C = view.X_CO * Eigen::Vector3d(corners_O[i].x, corners_O[i].y, corners_O[i].z);
    sum += (intrinsics.project(p_C) - corners[i]).squaredNorm();
  }
  view.rms_px = std::sqrt(sum / static_cast<double>(corners.size()));
  return view;
}

std::vector<LaserPoint> points_by_guess(const StillPose& pose, const BoardView& view, const CheckerBoard& board, const Pose& X_CL,
                                        const GuessGate& gate) {
  const Pose X_LO = X_CL.inverse() * view.X_CO;
  const Eigen::Vector3d normal = X_LO.linear().col(2), middle = X_LO.translation();
  const Eigen::Vector2d across(normal.x(), normal.y());
  // A board that lies as flat as the laser's plane has no line in it.
  if (across.norm() < 0.1) return {};
  const Eigen::Vector2d direction = Eigen::Vector2d(-across.y(), across.x()).normalized();
  // From below the board's middle along the board into the laser's plane: z / |across| is the way, seen from above.
  const Eigen::Vector2d expected = middle.head<2>() + across.normalized() * (normal.z() / across.norm()) * middle.z();
  // How long a line through the board's middle is in this direction.
  const Eigen::Vector3d along = X_LO.linear().transpose() * Eigen::Vector3d(direction.x(), direction.y(), 0.0);
  const Eigen::Vector2d half = board.half_size();
  const double length = 2.0 * std::min(half.x() / std::max(std::abs(along.x()), 1e-9), half.y() / std::max(std::abs(along.y()), 1e-9));
  const double far_m = gate.distance_m + middle.norm() * std::sin(to_radians(gate.angle_deg));

  std::vector<LaserPoint> best;
  double best_cost = 3.0;
  for (ScanLine& line : scan_lines(pose)) {
    const double off = (line.middle_L - expected).norm() / std::max(far_m, 1e-6);
    // The board's own place in the laser's plane turns what is seen of a tilted one; hence twice the angle.
    const double turned = std::acos(std::min(1.0, std::abs(line.direction_L.dot(direction)))) / to_radians(2.0 * gate.angle_deg + 5.0);
    const double longer = line.length_m / length;
    if (off > 1.0 || turned > 1.0 || longer < 0.4 || longer > 1.5) continue;
    const double cost = off * off + turned * turned + std::pow(std::log(longer) / std::log(1.5), 2);
    if (cost >= best_cost) continue;
    best_cost = cost;
    best = std::move(line.points);
  }
  return best;
}

std::vector<LaserPoint> points_by_estimate(const StillPose& pose, const BoardView& view, const CheckerBoard& board, const Pose& X_CL,
                                           double bias_m, double gate_m) {
  const Pose X_OL = view.X_CO.inverse() * X_CL;
  const Eigen::Vector3d origin = X_OL.translation();
  const Eigen::Vector2d half = board.half_size();
  std::vector<BeamMean> met;
  for (const BeamMean& beam : pose.beams) {
    if (!steady(beam, pose.scans)) continue;
    const Eigen::Vector3d ray = X_OL.linear() * Eigen::Vector3d(std::cos(beam.angle), std::sin(beam.angle), 0.0);
    if (ray.z() < 0.1) continue;  // more grazing than 84 deg, or from behind
    const double range = -origin.z() / ray.z();
    const Eigen::Vector3d p_O = origin + range * ray;
    // The wider the more a beam grazes.
    const double edge = beside(range) / ray.z();
    if (range <= 0.0 || std::abs(p_O.x()) > half.x() - edge || std::abs(p_O.y()) > half.y() - edge) continue;
    if (std::abs(beam.range_m - bias_m - range) > gate_m) continue;
    met.push_back(beam);
  }
  if (met.size() < kLeastPoints) return {};
  return laser_points(met);
}

}  // namespace waretwin
