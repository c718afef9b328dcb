#include "sim/frame_images.h"

#include <algorithm>

namespace waretwin {

std::vector<std::string> class_names(const Scene& scene) {
  std::vector<std::string> names = {"background"};
  for (const TrueObject& object : scene.objects) {
    if (std::find(names.begin(), names.end(), object.class_name) == names.end()) names.push_back(object.class_name);
  }
  return names;
}

PixelRays::PixelRays(const Intrinsics& intrinsics, const Pose& X_WC)
    : origin_(X_WC.translation().cast<float>()),
      corner_(X_WC.linear() * intrinsics.ray(0.0, 0.0)),
      right_(X_WC.linear().col(0) / intrinsics.fx),
      down_(X_WC.linear().col(1) / intrinsics.fy),
      spread_(static_cast<float>(1.0 / intrinsics.fx)) {}

Ray PixelRays::at(double u, double v) const {
  Ray ray;
  ray.origin = origin_;
  ray.direction = (corner_ + u * right_ + v * down_).cast<float>();
  return ray;
}

}  // namespace waretwin
