// The rays along which a camera looks while it takes one picture.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/pose.h"
#include "sensors/intrinsics.h"
#include "sim/ray_caster.h"

namespace waretwin {

// Directions have z = 1 in the camera's frame, so that distances along a ray are depths.
class PixelRays {
 public:
  // Where the camera is while one row is exposed.
  struct Row {
    Pose X_WC_begin = Pose::Identity(), X_WC = Pose::Identity(), X_WC_end = Pose::Identity();  // first, middle, last moment
    float begin = Ray().time, middle = Ray().time, end = Ray().time;                           // the same as Ray::time
  };

  // A pinhole camera, all pixels at one moment, which `time` is as Ray::time.
  PixelRays(const Intrinsics& intrinsics, const Pose& X_WC, float time = Ray().time);
  // Through a lens, each row at its own time. `directions`: CV_32FC2, x and y of each pixel's ray (x, y, 1), shared, not copied. As many
  // rows as it has. `spread`: angle of a pixel, radians.
  PixelRays(const cv::Mat& directions, double spread, const std::vector<Row>& rows);

  int width() const { return width_; }
  int height() const { return height_; }
  float spread() const { return spread_; }  // angle of a pixel in the middle of the image, radians
  // Whether anything may change during an exposure.
  bool lasts() const { return lasts_; }

  // Through the middle of pixel (u, v), in the middle of its exposure. A pixel outside the picture has some ray.
  Ray at(int u, int v) const;
  // Through any place; `moment` in [0, 1) from the first to the last of the exposure.
  Ray at(double u, double v, float moment) const;
  // From the world to the camera in the middle of row v's exposure.
  Eigen::Matrix3f R_CW(int v) const;

 private:
  struct Station {
    Eigen::Vector3f origin;
    Eigen::Matrix3f R_WC;
    float time;
  };
  struct Stations {
    Station begin, middle, end;
  };
  Eigen::Vector3f pinhole(double u, double v) const { return (corner_ + u * right_ + v * down_).cast<float>(); }
  Eigen::Vector2f bent(double u, double v) const;  // between the pixels' directions, linear

  int width_, height_;
  float spread_;
  bool lasts_ = false;
  // Pinhole.
  Station station_{};
  Eigen::Vector3d corner_, right_, down_;  // direction of pixel (0, 0) and its change from pixel to pixel, in W
  // Lens and rows; empty for the pinhole.
  cv::Mat directions_;
  std::vector<Stations> rows_;
};

// Inline for the same reason as DirectLight::shadow_ray.
inline Ray PixelRays::at(int u, int v) const {
  Ray ray;
  if (rows_.empty()) {
    ray.origin = station_.origin;
    ray.time = station_.time;
    ray.direction = pinhole(u, v);
    return ray;
  }
  const int y = std::clamp(v, 0, height_ - 1);
  const cv::Vec2f& direction = directions_.ptr<cv::Vec2f>(y)[std::clamp(u, 0, width_ - 1)];
  const Station& station = rows_[static_cast<std::size_t>(y)].middle;
  ray.origin = station.origin;
  ray.time = station.time;
  ray.direction = station.R_WC * Eigen::Vector3f(direction[0], direction[1], 1.0f);
  return ray;
}

}  // namespace waretwin
