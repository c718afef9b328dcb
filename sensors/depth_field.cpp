#include "sensors/depth_field.h"

#include <cmath>

#include "core/parallel.h"
#include "core/pose.h"

namespace waretwin {

bool inside_outline(const DepthField& field, double x, double y) {
  const double across = std::abs(x) / std::tan(to_radians(0.5 * field.horizontal_deg));
  const double down = std::abs(y) / std::tan(to_radians(0.5 * field.vertical_deg));
  if (across > 1.0 || down > 1.0) return false;
  if (field.shape == "hexagon") return across + 0.5 * down <= 1.0;
  if (field.shape == "circle") return across * across + down * down <= 1.0;
  return true;
}

bool in_depth_field(const DepthField& field, const Eigen::Vector3d& ray_C) {
  const double tilt = to_radians(field.tilt_down_deg);
  // Tilting the depth camera down turns its z axis towards the colour camera's y axis, which points down.
  const double z = std::cos(tilt) * ray_C.z() + std::sin(tilt) * ray_C.y();
  const double y = std::cos(tilt) * ray_C.y() - std::sin(tilt) * ray_C.z();
  if (z <= 0.0) return false;
  return inside_outline(field, ray_C.x() / z, y / z);
}

cv::Mat depth_field_mask(const CameraConfig& camera) {
  const Lens view = camera.view();
  cv::Mat mask(camera.height, camera.width, CV_8UC1);
  for (int v = 0; v < mask.rows; ++v) {
    auto* row = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) {
      const auto ray = view.ray(u, v);
      row[u] = ray && in_depth_field(camera.field, *ray) ? 255 : 0;
    }
  }
  return mask;
}

cv::Mat depth_rays(const CameraConfig& camera) {
  const Lens lens = camera.depth_lens();
  cv::Mat rays(lens.intrinsics().height, lens.intrinsics().width, CV_32FC3, cv::Scalar::all(0));
  parallel_for(static_cast<std::size_t>(rays.rows), 8, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < rays.cols; ++u) {
        const auto ray = lens.ray(u, v);
        if (!ray || !inside_outline(camera.field, ray->x(), ray->y())) continue;
        rays.at<cv::Vec3f>(v, u) = {static_cast<float>(ray->x()), static_cast<float>(ray->y()), 1.0f};
      }
    }
  });
  return rays;
}

}  // namespace waretwin
