#include "harness/calibrate/line_search.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "harness/calibrate/closed_form.h"

namespace waretwin {

namespace {

// Of the same beam in another pose.
bool stands_there(const ScanLine& line, const StillPose& other) {
  constexpr double kSame_m = 0.03;
  std::size_t same = 0, beam = 0;
  for (const LaserPoint& point : line.points) {
    while (beam < other.beams.size() && other.beams[beam].angle < point.angle) ++beam;
    if (beam == other.beams.size()) break;
    same += std::abs(other.beams[beam].range_m - point.range_m) < kSame_m ? 1 : 0;
  }
  return 2 * same >= line.points.size();
}

PlaneAndPoints plane_with(const BoardView& board, const ScanLine& line) {
  // Ends and middle say all that a line says.
  PlaneAndPoints plane{board.normal_C(), board.distance_m(), {}};
  for (const double along : {-0.5, 0.0, 0.5}) {
    const Eigen::Vector2d p = line.middle_L + along * line.length_m * line.direction_L;
    plane.points_L.emplace_back(p.x(), p.y(), 0.0);
  }
  return plane;
}

// How far a line is from its board: metres off its plane (rms); nothing where it is beside the squares.
std::optional<double> off_board(const PlaneAndPoints& plane, const BoardView& view, const CheckerBoard& board, const Pose& X_CL) {
  constexpr double kMargin_m = 0.1;
  const Pose X_OL = view.X_CO.inverse() * X_CL;
  const Eigen::Vector2d half = board.half_size();
  double sum = 0.0;
  for (const Eigen::Vector3d& p_L : plane.points_L) {
    const Eigen::Vector3d p_O = X_OL * p_L;
    if (std::abs(p_O.x()) > half.x() + kMargin_m || std::abs(p_O.y()) > half.y() + kMargin_m) return std::nullopt;
    sum += p_O.z() * p_O.z();
  }
  return std::sqrt(sum / static_cast<double>(plane.points_L.size()));
}

// The closed form of what agrees, and once more what agrees with that, while more do.
std::optional<LineSearch> settled(const std::vector<BoardAndLines>& poses, const CheckerBoard& board, LineSearch found) {
  constexpr int kRounds = 5;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<PlaneAndPoints> planes;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (found.line[i] >= 0)
        planes.push_back(plane_with(poses[i].board, poses[i].candidates.lines[static_cast<std::size_t>(found.line[i])]));
    }
    if (planes.size() < 5) return std::nullopt;
    LineSearch next;
    try {
      next = agreeing_lines(poses, board, closed_form_X_CL(planes));
    } catch (const Error&) {
      return std::nullopt;  // these leave it open
    }
    const bool same = next.line == found.line;
    found = std::move(next);
    if (same) break;
  }
  return found;
}

}  // namespace

std::vector<BoardLines> board_lines(const std::vector<StillPose>& still, const CheckerBoard& board) {
  // The spot adds to a board's length, and the ends that are left out take from it.
  const double longest = 2.0 * board.half_size().norm() + 0.1, shortest = 0.8 * board.half_size().minCoeff();
  std::vector<BoardLines> all;
  for (const StillPose& pose : still) {
    BoardLines found{scan_lines(pose), 0};
    std::erase_if(found.lines, [&](const ScanLine& line) { return line.length_m < shortest || line.length_m > longest; });
    const auto moved = std::stable_partition(found.lines.begin(), found.lines.end(), [&](const ScanLine& line) {
      const auto poses = std::count_if(still.begin(), still.end(), [&](const StillPose& other) { return stands_there(line, other); });
      return 4 * (poses - 1) <= static_cast<std::ptrdiff_t>(still.size());  // it stands in its own
    });
    found.moved = static_cast<std::size_t>(moved - found.lines.begin());
    all.push_back(std::move(found));
  }
  return all;
}

LineSearch agreeing_lines(const std::vector<BoardAndLines>& poses, const CheckerBoard& board, const Pose& X_CL) {
  // The closed form of few lines is no better, nor are ranges that all read too long.
  constexpr double kOff_m = 0.05;
  LineSearch found{X_CL, std::vector<int>(poses.size(), -1), 0};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double least = kOff_m;
    for (std::size_t k = 0; k < poses[i].candidates.lines.size(); ++k) {
      const std::optional<double> off = off_board(plane_with(poses[i].board, poses[i].candidates.lines[k]), poses[i].board, board, X_CL);
      if (!off || *off >= least) continue;
      least = *off;
      found.line[i] = static_cast<int>(k);
    }
    found.agreed += found.line[i] >= 0 ? 1 : 0;
  }
  return found;
}

std::optional<LineSearch> search_lines(const std::vector<BoardAndLines>& poses, const CheckerBoard& board) {
  constexpr int kTrials = 1000;
  constexpr std::size_t kSample = 6;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].candidates.lines.empty()) order.push_back(i);
  }
  if (order.size() < kSample) return std::nullopt;
  const RandomStream random(0, "calibrate", "line_search");
  std::optional<LineSearch> best;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    LineSearch sample{Pose::Identity(), std::vector<int>(poses.size(), -1), 0};
    std::uint32_t draw = 0;
    const auto below = [&](std::size_t count) {
      return std::min(count - 1, static_cast<std::size_t>(random.uniform(trial, draw++) * static_cast<double>(count)));
    };
    for (std::size_t i = 0; i < kSample; ++i) {
      std::swap(order[i], order[i + below(order.size() - i)]);
      const BoardLines& candidates = poses[order[i]].candidates;
      sample.line[order[i]] = static_cast<int>(below(candidates.moved > 0 ? candidates.moved : candidates.lines.size()));
    }
    const std::optional<LineSearch> found = settled(poses, board, std::move(sample));
    if (found && found->agreed >= static_cast<int>(kSample) && (!best || found->agreed > best->agreed)) best = found;
    if (best && best->agreed == static_cast<int>(order.size())) break;
  }
  return best;
}

}  // namespace waretwin
