// Poses in monogram notation: X_AB is the pose of frame B in frame A, so that p_A = X_AB * p_B and X_AC = X_AB * X_BC.
//
// Frames: W world (z up, metres), B vehicle base (x forward, z up, on the floor), C colour camera (z forward, x right, y down),
// D depth camera, L laser (x forward, z up), O object, G glTF (y up).
#pragma once

#include <Eigen/Geometry>

namespace waretwin {

using Pose = Eigen::Isometry3d;

// Angle wrapped to (-pi, pi].
double wrap_angle(double radians);

// The smallest rotation that separates two headings which look alike after every `period` radians (pi for a box seen from above,
// 2 pi for a vehicle). In [0, period / 2].
double angle_distance(double a, double b, double period);

double to_radians(double degrees);
double to_degrees(double radians);

// A pose that stands upright: rotation about z by yaw, at (x, y, z).
Pose make_upright_pose(double x, double y, double z, double yaw);

// Rotation from roll, pitch and yaw in radians: R = Rz(yaw) * Ry(pitch) * Rx(roll) (x forward, y left, z up).
Eigen::Matrix3d rotation_from_rpy(double roll, double pitch, double yaw);

// Heading of a pose's x axis in the x-y plane, in (-pi, pi]. Roll and pitch are ignored.
double yaw_of(const Pose& X_AB);

// Turns a forward-left-up frame into the camera's right-down-forward: R_BC of a camera that looks along the vehicle's x axis.
Eigen::Matrix3d optical_from_forward();

// The pose at fraction t in [0, 1] on the way from a to b: translation linear, rotation by slerp.
Pose interpolate(const Pose& a, const Pose& b, double t);

// Rotation angle between two poses in radians, in [0, pi].
double rotation_between(const Pose& a, const Pose& b);

// X with its rotation made orthonormal again (poses read from text are not).
Pose orthonormalised(const Pose& X_AB);

}  // namespace waretwin
