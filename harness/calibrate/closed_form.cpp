#include "harness/calibrate/closed_form.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/error.h"

namespace waretwin {

namespace {

std::string degrees(double radians) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f deg", to_degrees(radians));
  return text;
}

// Between lines: a normal and its opposite are one.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::asin(std::min(1.0, a.cross(b).norm())); }

constexpr const char* kExpected = "; expected boards turned to the left and right and tilted to and fro by 20 deg and more";

}  // namespace

void expect_determined(const std::vector<Eigen::Vector3d>& normals_C, int least_poses, double angle_deg, const Eigen::Matrix3d& R_BC) {
  const std::string poses = std::to_string(normals_C.size()) + (normals_C.size() == 1 ? " board pose" : " board poses");
  double widest = 0.0;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& a : normals_C) {
    scatter += a * a.transpose() / static_cast<double>(normals_C.size());
    for (const Eigen::Vector3d& b : normals_C) widest = std::max(widest, angle_between(a, b));
  }
  const bool few = static_cast<int>(normals_C.size()) < least_poses;
  if (normals_C.size() > 1 && widest < to_radians(angle_deg)) {
    throw Error("the motion of the board is degenerate: " + poses + " with parallel boards (their normals differ by at most " +
                degrees(widest) + "), which leave shifts along the boards and a turn about their normal open" + kExpected +
                (few ? ", in at least " + std::to_string(least_poses) + " poses" : ""));
  }
  if (few) {
    throw Error(poses + " that camera and laser both saw; expected at least " + std::to_string(least_poses) +
                ", turned and tilted differently");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  const double out_of_plane = std::asin(std::min(1.0, std::sqrt(std::max(0.0, eigen.eigenvalues()[0]))));
  if (out_of_plane >= to_radians(0.5 * angle_deg)) return;
  const Eigen::Vector3d open_B = R_BC * eigen.eigenvectors().col(0);
  char direction[96];
  std::snprintf(direction, sizeof direction, "(%.2f, %.2f, %.2f)", open_B.x(), open_B.y(), open_B.z());
  throw Error("the motion of the board is degenerate: the normals of all " + poses + " lie in one plane (within " + degrees(out_of_plane) +
              " rms), which leaves a shift along " + direction + " of the vehicle (x forward, y left, z up) open" + kExpected);
}

Pose closed_form_X_CL(const std::vector<PlaneAndPoints>& planes) {
  Eigen::Index rows = 0;
  for (const PlaneAndPoints& plane : planes) rows += static_cast<Eigen::Index>(plane.points_L.size());
  Eigen::MatrixXd a(std::max<Eigen::Index>(rows, 9), 9);
  Eigen::VectorXd b(a.rows());
  a.setZero();
  b.setZero();
  Eigen::Index row = 0;
  for (const PlaneAndPoints& plane : planes) {
    for (const Eigen::Vector3d& p : plane.points_L) {
      a.row(row) << p.x() * plane.normal_C.transpose(), p.y() * plane.normal_C.transpose(), plane.normal_C.transpose();
      b[row] = plane.distance_m;
      ++row;
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double ratio = svd.singularValues()[8] / svd.singularValues()[0];
  if (!(ratio > 1e-5)) {
    throw Error("the motion of the board is degenerate: the laser's lines on " + std::to_string(planes.size()) +
                " boards leave the pose open (condition " + std::to_string(ratio) + ")" + kExpected);
  }
  const Eigen::VectorXd h = svd.solve(b);
  Eigen::Matrix3d turn;
  turn << h.segment<3>(0), h.segment<3>(3), h.segment<3>(0).cross(h.segment<3>(3));
  const Eigen::JacobiSVD<Eigen::Matrix3d> nearest(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d mirror(1, 1, (nearest.matrixU() * nearest.matrixV().transpose()).determinant() < 0.0 ? -1 : 1);
  Pose X_CL = Pose::Identity();
  X_CL.linear() = nearest.matrixU() * mirror.asDiagonal() * nearest.matrixV().transpose();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const PlaneAndPoints& plane : planes) {
    for (const Eigen::Vector3d& p : plane.points_L) {
      normal += plane.normal_C * plane.normal_C.transpose();
      right += plane.normal_C * (plane.distance_m - plane.normal_C.dot(X_CL.linear() * p));
    }
  }
  X_CL.translation() = normal.ldlt().solve(right);
  return X_CL;
}

}  // namespace waretwin
