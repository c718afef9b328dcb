// The most likely mounting of the camera, given all corners and all laser points at once.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/fields.h"
#include "core/pose.h"
#include "harness/calibrate/board_view.h"

namespace waretwin {

struct RefineConfig {
  double range_bias_m = 0.02;  // how far all ranges may be off alike (data sheet); 0: they are not
  double loss_scale = 2.0;     // Huber: residuals beyond this many sigmas count less
  void visit(Fields& f);
};

struct Refined {
  Pose X_BC = Pose::Identity();
  std::vector<Pose> X_CO;  // of each view
  double bias_m = 0.0;     // ranges read so much too long
  // Of the camera's shift in metres and turn in radians, both in B's axes, X_BC = (p + shift, exp(turn) R), and of the bias in metres; its
  // row and column are 0 where none is estimated.
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  double corner_sigma_px = 0.0;  // of one coordinate of a mean corner, from the residuals
  double beam_factor = 0.0;      // the residuals of beams over what their own scatter says
  double rms_m = 0.0;            // of the beams' residuals, along the beams
  int points = 0;
};

// Minimises, over X_BC, the bias and the boards' poses, the squares of
//   corners: from where they are seen to where the board's pose puts them, in pixels,
//   beams: from a mean range to the board's plane along the beam, in metres; with a robust loss,
// each over its sigma. Both sigmas follow from the residuals themselves, so that the covariance means what it says though nobody knows how
// exact corners are. X_BL, where the laser sits, is kept. Views without points count for nothing. Throws Error where the observations do
// not determine the mounting.
Refined refine(const std::vector<BoardView>& views, const Intrinsics& intrinsics, const CheckerBoard& board, const Pose& X_BL,
               const Pose& X_BC_start, double bias_start_m, const RefineConfig& config);

// Throws Error naming the package that this program was built without, if it was: before anything long begins.
void expect_refinement();

}  // namespace waretwin
