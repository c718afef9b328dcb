// The pictures of one camera frame. All come from the same rays through the pixel centres, so they agree to the pixel.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sensors/intrinsics.h"
#include "sim/ray_caster.h"

namespace waretwin {

// Names of classes in the order of their numbers in class images: 0 = background, then as the scene's objects first name them.
std::vector<std::string> class_names(const Scene& scene);

struct FrameImages {
  cv::Mat colour;     // CV_8UC3, BGR; empty when not asked for
  cv::Mat depth;      // CV_32FC1, metres along the optical axis, 0 = no surface
  cv::Mat instances;  // CV_16UC1, TrueObject::id, 0 = background
  cv::Mat classes;    // CV_16UC1, index into class_names(); empty when not asked for
  cv::Mat normals;    // CV_32FC3, unit, camera frame, towards the camera, zero where no surface; empty when not asked for
};

// The ray through the middle of pixel (u, v). Its direction has z = 1 in the camera's frame, so that distances along it are depths.
class PixelRays {
 public:
  PixelRays(const Intrinsics& intrinsics, const Pose& X_WC);
  Ray at(double u, double v) const;
  float spread() const { return spread_; }  // angle of a pixel in the middle of the image, radians

 private:
  Eigen::Vector3f origin_;
  Eigen::Vector3d corner_, right_, down_;  // direction of pixel (0, 0) and its change from pixel to pixel, in W
  float spread_;
};

}  // namespace waretwin
