// A room of boxes with a closed-form depth image and a closed-form distance to its surfaces.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "core/pose.h"
#include "core/random.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin::test {

struct SceneBox {
  Eigen::Vector3d low, high;
  std::int32_t label = 0;
};

struct BoxScene {
  // The room is seen from inside, the boxes in it from outside.
  SceneBox room{{-2.0, -2.0, 0.0}, {2.0, 2.0, 2.6}, 0};
  std::vector<SceneBox> boxes{
      {{-0.9, 0.5, 0.0}, {-0.2, 1.1, 0.9}, 1}, {{0.3, 0.7, 0.0}, {0.9, 1.3, 0.5}, 2}, {{0.35, 0.8, 0.5}, {0.65, 1.05, 0.7}, 3}};

  // Distance along a ray to the first surface, and its label; `direction` of any length sets the unit.
  double trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, std::int32_t& label) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      if (direction[k] == 0.0) continue;
      nearest = std::min(nearest, ((direction[k] > 0.0 ? room.high[k] : room.low[k]) - origin[k]) / direction[k]);
    }
    label = room.label;
    for (const SceneBox& box : boxes) {
      double enter = 0.0, leave = std::numeric_limits<double>::infinity();
      for (int k = 0; k < 3; ++k) {
        const double a = (box.low[k] - origin[k]) / direction[k], b = (box.high[k] - origin[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      if (enter < leave && enter < nearest) {
        nearest = enter;
        label = box.label;
      }
    }
    return nearest;
  }

  // Distance of a point to the nearest surface.
  double distance(const Eigen::Vector3d& p) const {
    double nearest = std::min((p - room.low).cwiseAbs().minCoeff(), (room.high - p).cwiseAbs().minCoeff());
    for (const SceneBox& box : boxes) {
      const Eigen::Vector3d q = (p - 0.5 * (box.low + box.high)).cwiseAbs() - 0.5 * (box.high - box.low);
      nearest = std::min(nearest, std::abs(q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0)));
    }
    return nearest;
  }
};

// A camera at `eye` that looks at `target`, image upright.
inline Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Pose X = Pose::Identity();
  X.linear().col(0) = x;
  X.linear().col(1) = z.cross(x);
  X.linear().col(2) = z;
  X.translation() = eye;
  return X;
}

struct LabelledFrame {
  RgbdFrame frame;
  std::vector<std::int32_t> labels;
};

// Depth with peers' noise (2 mm + 1.5 mm/m^2 z^2, 3 % of pixels missing) where `noisy`, in whole millimetres; a colour per label.
inline LabelledFrame view(const BoxScene& scene, const Intrinsics& camera, const Pose& X_WC, bool noisy, Stamp stamp = 0) {
  LabelledFrame out;
  out.frame.stamp = stamp;
  out.frame.depth = cv::Mat(camera.height, camera.width, CV_32FC1);
  out.frame.colour = cv::Mat(camera.height, camera.width, CV_8UC3);
  out.labels.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  const RandomStream noise(7, "camera", "depth", stamp), dropout(7, "camera", "dropout", stamp);
  parallel_for(static_cast<std::size_t>(camera.height), 8, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const std::size_t i = static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u);
        std::int32_t label = 0;
        double z = scene.trace(X_WC.translation(), X_WC.linear() * camera.ray(u, v), label);
        if (noisy) z = dropout.uniform(i) < 0.03 ? 0.0 : z + (0.002 + 0.0015 * z * z) * noise.normal(i);
        out.frame.depth.at<float>(v, u) = static_cast<float>(std::round(z * 1000.0)) * 0.001f;
        out.labels[i] = label;
        out.frame.colour.at<cv::Vec3b>(v, u) =
            cv::Vec3b(static_cast<std::uint8_t>(50 * label), static_cast<std::uint8_t>(200 - 50 * label), 77);
      }
    }
  });
  return out;
}

}  // namespace waretwin::test
