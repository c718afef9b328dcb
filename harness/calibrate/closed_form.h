// The camera against the laser in closed form: Zhang and Pless, "Extrinsic calibration of a camera and laser range finder (improves camera
// calibration)", IROS 2004, section III.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/pose.h"

namespace waretwin {

// A board's plane in the camera's frame, normal_C . p_C = distance_m with a unit normal, and points of the laser on it, z_L = 0.
struct PlaneAndPoints {
  Eigen::Vector3d normal_C = Eigen::Vector3d::UnitZ();
  double distance_m = 0.0;
  std::vector<Eigen::Vector3d> points_L;
};

// Throws Error that names what is wrong where the planes cannot determine a pose: all parallel, fewer than `least_poses`, or with normals
// that all lie in one plane, so that a shift across it changes nothing. `R_BC` turns that shift into the vehicle's frame for the message.
// Planes count as parallel, or as in one plane, when they are within `angle_deg`.
void expect_determined(const std::vector<Eigen::Vector3d>& normals_C, int least_poses, double angle_deg, const Eigen::Matrix3d& R_BC);

// X_CL. Each point says normal_C . (H * (x, y, 1)) = distance, with H = [r1 r2 t]: linear in H, whose first two columns are then made those
// of the nearest rotation, after which t alone is solved again. Exact for exact data. Throws Error where the equations leave H open.
Pose closed_form_X_CL(const std::vector<PlaneAndPoints>& planes);

}  // namespace waretwin
