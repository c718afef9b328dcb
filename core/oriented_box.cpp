#include "core/oriented_box.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"

namespace waretwin {

namespace {

// A convex polygon in space. A rectangle clipped by six half spaces has at most ten corners; rounding can cut a sliver twice.
struct Face {
  std::array<Eigen::Vector3d, 24> corners;
  std::size_t count = 0;

  void add(const Eigen::Vector3d& p) {
    WARETWIN_CHECK(count < corners.size(), "a clipped box face has few corners");
    corners[count++] = p;
  }

  double area() const {
    Eigen::Vector3d twice = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < count; ++i) twice += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    return 0.5 * twice.norm();
  }
};

// The face of a box of half edges h, around the origin, that looks along sign * axis.
Face face_of(const Eigen::Vector3d& h, int axis, double sign) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Face face;
  for (const auto& [su, sv] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    Eigen::Vector3d p;
    p[axis] = sign * h[axis];
    p[u] = su * h[u];
    p[v] = sv * h[v];
    face.add(p);
  }
  return face;
}

// One step of Sutherland-Hodgman: what lies in sign * p[axis] <= limit.
Face clipped(const Face& face, int axis, double sign, double limit) {
  Face out;
  for (std::size_t i = 0; i < face.count; ++i) {
    const Eigen::Vector3d& p = face.corners[i];
    const Eigen::Vector3d& q = face.corners[(i + 1) % face.count];
    const double excess_p = sign * p[axis] - limit;
    const double excess_q = sign * q[axis] - limit;
    if (excess_p <= 0) out.add(p);
    if ((excess_p < 0 && excess_q > 0) || (excess_p > 0 && excess_q < 0)) out.add(p + (q - p) * (excess_p / (excess_p - excess_q)));
  }
  return out;
}

// Area of that part of a face of box `b` (half edges h_b, pose X_AB in a's axes) which lies inside box a grown by `margin`.
double area_inside(const Eigen::Vector3d& h_a, const Eigen::Vector3d& h_b, const Pose& X_AB, int axis, double sign, double margin) {
  Face face = face_of(h_b, axis, sign);
  for (std::size_t i = 0; i < face.count; ++i) face.corners[i] = X_AB * face.corners[i];
  for (int k = 0; k < 3 && face.count > 0; ++k) {
    face = clipped(face, k, 1.0, h_a[k] + margin);
    face = clipped(face, k, -1.0, h_a[k] + margin);
  }
  return face.area();
}

}  // namespace

OrientedBox oriented_box_from_corners(const std::array<Eigen::Vector3d, 8>& corners) {
  constexpr double kTolerance = 1e-3;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) {
    if (!corner.allFinite()) throw Error("a box corner is not finite; expected finite coordinates");
    centre += corner / 8.0;
  }
  // Column k: the mean of the four edges along axis k.
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  for (int index = 0; index < 8; ++index) {
    for (int axis = 0; axis < 3; ++axis) edges.col(axis) += (index & (4 >> axis) ? 0.25 : -0.25) * corners[static_cast<std::size_t>(index)];
  }
  const Eigen::Vector3d size = edges.colwise().norm();
  const double largest = size.maxCoeff();
  for (int index = 0; index < 8; ++index) {
    Eigen::Vector3d ideal = centre;
    for (int axis = 0; axis < 3; ++axis) ideal += (index & (4 >> axis) ? 0.5 : -0.5) * edges.col(axis);
    const double error = (ideal - corners[static_cast<std::size_t>(index)]).norm();
    if (error > kTolerance * largest) {
      std::ostringstream text;
      text << "corner " << index << " lies " << error << " m off a parallelepiped; expected the corners of a box in the order of its axes";
      throw Error(text.str());
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3;
    const double cosine = edges.col(axis).dot(edges.col(next));
    if (std::abs(cosine) > kTolerance * size[axis] * size[next])
      throw Error("box edges are not at right angles; expected a right-angled box");
  }
  // The nearest rotation to the edge directions; an edge without length takes what the others leave.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] > 0) directions.col(axis) = edges.col(axis) / size[axis];
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(directions, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  // A box is its own mirror image: left-handed corners describe the same box.
  if (rotation.determinant() < 0) rotation.col(2) *= -1.0;
  OrientedBox box;
  box.X_AO.linear() = rotation;
  box.X_AO.translation() = centre;
  box.size = size;
  return box;
}

double intersection_volume(const OrientedBox& a, const OrientedBox& b) {
  if (!(a.size.minCoeff() > 0.0) || !(b.size.minCoeff() > 0.0)) return 0.0;
  const Eigen::Vector3d h_a = 0.5 * a.size;
  const Eigen::Vector3d h_b = 0.5 * b.size;
  const Pose X_ab = a.X_AO.inverse() * b.X_AO;
  const Pose X_ba = X_ab.inverse();
  // The rest's surface is a's faces inside b and b's faces inside a. Where two faces coincide only a's may count: a's faces see b a
  // hair larger, b's faces see a a hair smaller.
  const double hair = 1e-12 * std::max({h_a.maxCoeff(), h_b.maxCoeff(), X_ab.translation().norm()});
  double volume = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      // Divergence theorem about b's centre: a third of area times the face plane's distance.
      const double distance_a = h_a[axis] - sign * X_ab.translation()[axis];
      volume += distance_a * area_inside(h_b, h_a, X_ba, axis, sign, hair) / 3.0;
      volume += h_b[axis] * area_inside(h_a, h_b, X_ab, axis, sign, -hair) / 3.0;
    }
  }
  return std::clamp(volume, 0.0, std::min(a.size.prod(), b.size.prod()));
}

double iou_3d(const OrientedBox& a, const OrientedBox& b) {
  const double volume_a = a.size.prod();
  const double volume_b = b.size.prod();
  if (!(volume_a > 0.0) || !(volume_b > 0.0)) return 0.0;
  const double shared = intersection_volume(a, b);
  return std::clamp(shared / (volume_a + volume_b - shared), 0.0, 1.0);
}

}  // namespace waretwin
