// A pose of the board as the camera sees it, and which beams of the laser met it there.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/fields.h"
#include "core/pose.h"
#include "harness/calibrate/checker_board.h"
#include "harness/calibrate/scan_lines.h"
#include "sensors/intrinsics.h"

namespace waretwin {

struct BoardView {
  std::vector<Eigen::Vector2d> corners;                                     // pixels
  Pose X_CO = Pose::Identity();                                             // from the corners
  double rms_px = 0.0;                                                      // of what the pose leaves of them, both axes together
  std::vector<LaserPoint> points;                                           // empty: none were found
  Eigen::Vector3d normal_C() const { return X_CO.linear().col(2); }         // away from the camera
  double distance_m() const { return normal_C().dot(X_CO.translation()); }  // of the plane from C, above 0
};

// Where the board stands, from its corners alone (PnP). Nothing where no pose explains them.
std::optional<BoardView> view_board(const std::vector<Eigen::Vector2d>& corners, const Intrinsics& intrinsics, const CheckerBoard& board);

// How wrong the poses may be that are known beforehand, for them to tell which line is the board (else: line_search.h).
struct GuessGate {
  double distance_m = 0.3;
  double angle_deg = 10.0;
  void visit(Fields& f);
};

// Points by a guess of X_CL: the line of the scan that is about as long as the board and nearest to where it should be, in the gate. Empty
// where there is none.
std::vector<LaserPoint> points_by_guess(const StillPose& pose, const BoardView& view, const CheckerBoard& board, const Pose& X_CL,
                                        const GuessGate& gate);

// Points by an estimate: beams that meet the printed squares, a spot's width inside, and whose range less `bias_m` is within `gate_m` of
// that to the board.
std::vector<LaserPoint> points_by_estimate(const StillPose& pose, const BoardView& view, const CheckerBoard& board, const Pose& X_CL,
                                           double bias_m, double gate_m);

}  // namespace waretwin
