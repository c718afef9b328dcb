// A calibration told: text for people, JSON for tools, and, where the truth is known, how wrong it is.
#pragma once

#include <optional>
#include <string>

#include "harness/calibrate/calibration.h"
#include "scenes/scenario.h"

namespace waretwin {

// What a simulation knows of it.
struct CalibrationTruth {
  // Camera and laser as they really sit, and with the laser where it was taken to sit: X_BL_given * X_LC.
  Pose X_BC = Pose::Identity();
  double range_bias_m = 0.0;
};

// Of a vehicle that stands. The estimate may not see it.
CalibrationTruth true_calibration(const Scenario& scenario, const std::string& camera, const std::string& laser);

struct CalibrationError {
  Eigen::Vector3d shift_B = Eigen::Vector3d::Zero();  // estimate less truth, metres, the vehicle's axes
  Eigen::Vector3d turn_B = Eigen::Vector3d::Zero();   // radians, the vehicle's axes
  double chi2 = 0.0;                                  // of both together under the estimate's covariance: about 6 +- 3.5 for an honest one
};
// `covariance`: of shift and turn; where it is singular chi2 is NaN.
CalibrationError error_of(const Pose& X_BC, const Pose& X_BC_true, const Eigen::Matrix<double, 6, 6>& covariance);

std::string calibration_text(const Calibration& calibration, const std::optional<CalibrationTruth>& truth);
std::string calibration_json(const Calibration& calibration, const std::optional<CalibrationTruth>& truth);

}  // namespace waretwin
