// The pinhole camera. Pixel (u, v) has its centre at (u, v): the image covers u in [-0.5, width - 0.5].
#pragma once

#include <Eigen/Core>
#include <string>

namespace waretwin {

struct Intrinsics {
  int width = 0;              // pixels
  int height = 0;             // pixels
  double fx = 0.0, fy = 0.0;  // pixels
  double cx = 0.0, cy = 0.0;  // pixels

  // Rejects sizes outside 1..16384 and focal lengths that are not positive and finite (throws Error naming the value).
  static Intrinsics checked(int width, int height, double fx, double fy, double cx, double cy);
  // Principal point in the middle, fields of view over the full image in radians.
  static Intrinsics from_field_of_view(int width, int height, double horizontal, double vertical);

  // The ray through a pixel in the camera's frame, scaled to z = 1, so that depth * ray is the point.
  Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }
  // Pixel of a point with z > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p_C) const { return {fx * p_C.x() / p_C.z() + cx, fy * p_C.y() / p_C.z() + cy}; }
  bool contains(double u, double v) const { return u >= -0.5 && v >= -0.5 && u < width - 0.5 && v < height - 0.5; }
};

}  // namespace waretwin
