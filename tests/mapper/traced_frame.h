// An RGB-D frame of boxes on a floor by closed formulas: a few obvious lines instead of the simulation, which the mapper may not see.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "core/cuboid.h"
#include "core/random.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"
#include "sensors/sensor_stream.h"

namespace waretwin::test {

struct TracedScene {
  std::vector<Cuboid> boxes;
  std::vector<cv::Vec3b> colours;  // one a box (BGR)
  bool floor = true;               // the plane z = 0
};

inline Cuboid box(double x, double y, double bottom, double yaw, double dx, double dy, double dz) {
  return {{x, y, bottom + 0.5 * dz}, yaw, {dx, dy, dz}, "world"};
}

// Camera at `height` above (x, y), heading `yaw`, pitched down.
inline Pose camera_pose(double x, double y, double height, double yaw, double pitch_down) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = rotation_from_rpy(0.0, pitch_down, yaw) * optical_from_forward();
  X_WC.translation() = Eigen::Vector3d(x, y, height);
  return X_WC;
}

struct TracedFrame {
  RgbdFrame frame;
  std::vector<std::optional<cv::Rect2f>> boxes;  // 2D box of what is visible of each box
  std::vector<cv::Mat> masks;                    // CV_8U, 255 where a box is seen
};

// Depth with normal noise `sigma` (metres at any distance), rounded to millimetres.
inline TracedFrame trace(const TracedScene& scene, const Intrinsics& intrinsics, const Pose& X_WC, double sigma = 0.0,
                         std::uint64_t seed = 0) {
  TracedFrame traced;
  const cv::Size size(intrinsics.width, intrinsics.height);
  traced.frame.sensor = "camera";
  traced.frame.depth = cv::Mat::zeros(size, CV_32FC1);
  traced.frame.colour = cv::Mat(size, CV_8UC3, cv::Scalar(200, 200, 200));
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) traced.masks.push_back(cv::Mat::zeros(size, CV_8UC1));
  const RandomStream random(seed, "camera", "depth");
  std::vector<Pose> X_OC;
  for (const Cuboid& cuboid : scene.boxes) X_OC.push_back(cuboid.pose().inverse() * X_WC);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const Eigen::Vector3d ray_C = intrinsics.ray(u, v);
      double nearest = std::numeric_limits<double>::infinity();
      int hit = -1;
      const double slope = (X_WC.linear() * ray_C).z();
      if (scene.floor && slope < 0.0) nearest = -X_WC.translation().z() / slope;
      for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
        const Eigen::Vector3d d = X_OC[i].linear() * ray_C, o = X_OC[i].translation(), half = 0.5 * scene.boxes[i].size;
        double in = 0.0, out = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
          const double a = (-half[axis] - o[axis]) / d[axis], b = (half[axis] - o[axis]) / d[axis];
          in = std::max(in, std::min(a, b));
          out = std::min(out, std::max(a, b));
        }
        if (in < out && in > 0.0 && in < nearest) {
          nearest = in;
          hit = static_cast<int>(i);
        }
      }
      if (!std::isfinite(nearest)) continue;
      const double depth = nearest + (sigma > 0.0 ? sigma * random.normal(static_cast<std::uint64_t>(v) * size.width + u) : 0.0);
      traced.frame.depth.at<float>(v, u) = static_cast<float>(std::round(1000.0 * depth)) * 0.001f;
      if (hit < 0) continue;
      traced.masks[hit].at<std::uint8_t>(v, u) = 255;
      if (hit < static_cast<int>(scene.colours.size())) traced.frame.colour.at<cv::Vec3b>(v, u) = scene.colours[hit];
    }
  }
  for (const cv::Mat& mask : traced.masks) {
    int u0 = size.width, v0 = size.height, u1 = -1, v1 = -1;
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u) {
        if (!mask.at<std::uint8_t>(v, u)) continue;
        u0 = std::min(u0, u), u1 = std::max(u1, u), v0 = std::min(v0, v), v1 = std::max(v1, v);
      }
    }
    if (u1 < 0)
      traced.boxes.emplace_back();
    else
      traced.boxes.emplace_back(cv::Rect2f(cv::Point2f(u0, v0), cv::Point2f(u1 + 1, v1 + 1)));
  }
  return traced;
}

// The paper's camera: 90 x 59 deg, 1.4 m high, 45 deg down.
inline Intrinsics kinect(int width, int height) { return Intrinsics::from_field_of_view(width, height, to_radians(90), to_radians(59)); }

inline StreamInfo kinect_stream(const Intrinsics& intrinsics) {
  StreamInfo info;
  info.source = "traced";
  info.cameras["camera"] = {intrinsics, Pose::Identity(), 0.25, 3.86, 15.0};
  return info;
}

}  // namespace waretwin::test
