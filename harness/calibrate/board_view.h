// A pose of the board as the camera sees it, and which beams of the laser met it there.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/fields.h"
#include "core/pose.h"
#include "harness/calibrate/checker_board.h"
#include "harness/calibrate/still_poses.h"
#include "sensors/intrinsics.h"

namespace waretwin {

// A beam's mean that lies on the board.
struct LaserPoint {
  double angle = 0.0;    // radians, in the laser's frame
  double range_m = 0.0;  // as it reads
  double sigma_m = 0.0;  // of the mean, by chance alone
  Eigen::Vector3d direction_L() const { return {std::cos(angle), std::sin(angle), 0.0}; }
  Eigen::Vector3d p_L() const { return range_m * direction_L(); }
};

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

// How wrong the poses may be that the estimate begins with.
struct GuessGate {
  double distance_m = 0.3;
  double angle_deg = 10.0;
  void visit(Fields& f);
};

// Points by a guess of X_CL: the straight piece of the scan that is about as long as the board and nearest to where it should be, in the
// gate; its ends, where a beam's spot is half beside the board, are left out. Empty where there is none.
std::vector<LaserPoint> points_by_guess(const StillPose& pose, const BoardView& view, const CheckerBoard& board, const Pose& X_CL,
                                        const GuessGate& gate);

// Points by an estimate: beams that meet the printed squares, a spot's width inside, and whose range less `bias_m` is within `gate_m` of
// that to the board.
std::vector<LaserPoint> points_by_estimate(const StillPose& pose, const BoardView& view, const CheckerBoard& board, const Pose& X_CL,
                                           double bias_m, double gate_m);

}  // namespace waretwin
