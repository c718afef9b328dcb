// A camera lens: the pinhole camera with rational radial and tangential distortion (Brown's model as OpenCV and the Azure Kinect's own
// calibration write it).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/fields.h"
#include "sensors/intrinsics.h"

namespace waretwin {

// A point (x, y) on the plane z = 1, r2 = x^2 + y^2, goes to
//   s * x + 2 p1 x y + p2 (r2 + 2 x^2),  s * y + p1 (r2 + 2 y^2) + 2 p2 x y,
//   s = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3).
struct Distortion {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, k4 = 0.0, k5 = 0.0, k6 = 0.0;
  double p1 = 0.0, p2 = 0.0;

  bool is_none() const;
  Eigen::Vector2d apply(const Eigen::Vector2d& xy) const;
  Eigen::Matrix2d slope(const Eigen::Vector2d& xy) const;  // d apply / d xy
  void visit(Fields& f);
};

class Lens {
 public:
  explicit Lens(const Intrinsics& intrinsics, const Distortion& distortion = {});

  const Intrinsics& intrinsics() const { return intrinsics_; }
  const Distortion& distortion() const { return distortion_; }

  // The ray that a pixel sees, in the camera's frame, scaled to z = 1; nothing where the distortion folds over and no ray arrives.
  std::optional<Eigen::Vector3d> ray(double u, double v) const;
  // Pixel of a point; nothing for z <= 0 and beyond the angle at which the distortion folds over.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_C) const;

 private:
  Intrinsics intrinsics_;
  Distortion distortion_;
  double largest_r2_;  // up to here the distorted radius grows
};

}  // namespace waretwin
