#include "scenes/builder/finish_kinds.h"

#include <opencv2/imgproc.hpp>

#include "scenes/builder/paint.h"

namespace waretwin::builder {

using cv::Scalar;

Finish plain(const Eigen::Vector3d& colour, double metallic, double roughness, double reflectivity) {
  Finish f;
  f.colour = colour;
  f.metallic = metallic;
  f.roughness = roughness;
  f.reflectivity_850nm = reflectivity;
  return f;
}

Finish textured(const cv::Mat& texture, double width_m, double height_m, double metallic, double roughness, double reflectivity) {
  Finish f = plain({1, 1, 1}, metallic, roughness, reflectivity);
  f.texture = texture;
  f.texture_width_m = width_m;
  f.texture_height_m = height_m;
  return f;
}

Finish painted(const std::string& key, const Scalar& bgr, double roughness, double reflectivity, int scratches) {
  cv::Mat t = mottled(256, 256, bgr, 5, 5, key);
  add_stains(t, -22, 0.62, 4, key);
  add_scratches(t, scratches, 26, {150, 150, 150}, 0.45, key);
  return textured(t, 0.8, 0.8, 0.0, roughness, reflectivity);
}

Scalar bgr_of(const Eigen::Vector3d& srgb) { return {255 * srgb.z(), 255 * srgb.y(), 255 * srgb.x()}; }

Finish picture_of(const cv::Mat& picture, double roughness, double reflectivity) {
  Finish f = textured(picture, 1, 1, 0, roughness, reflectivity);
  f.picture = true;
  return f;
}

Finish screen(const cv::Mat& picture) {
  Finish f = picture_of(picture, 0.25, 0.1);
  f.emissive = {0.9, 0.9, 0.9};
  f.texture_glows = true;
  return f;
}

Finish wood(const std::string& key, const Scalar& bgr, double contrast) {
  cv::Mat t = mottled(512, 256, bgr, 8, 4, key);
  add_streaks(t, contrast, 128, key + " fibre");
  add_streaks(t, contrast, 512, key + " grain");
  const cv::Mat warp = tiling_noise(512, 256, 2, 3, key + " rings");
  for (int y = 0; y < t.rows; ++y) {
    for (int x = 0; x < t.cols; ++x) {
      const double ring = y * 0.06 + 6.0 * static_cast<double>(warp.at<float>(y, x));
      const double phase = ring - static_cast<int>(ring);
      if (phase > 0.82) t.at<cv::Vec3b>(y, x) *= 0.88;
    }
  }
  return textured(t, 1.0, 0.5, 0, 0.65, 0.65);
}

Finish fabric(const std::string& key, const Scalar& bgr) {
  cv::Mat t = mottled(128, 128, bgr, 6, 14, key);
  for (int k = 0; k < 128; k += 4) {
    cv::line(t, {k, 0}, {k, 127}, bgr * 0.85, 1);
    cv::line(t, {0, k}, {127, k}, bgr * 0.9, 1);
  }
  return textured(t, 0.12, 0.12, 0, 0.95, 0.35);
}

Finish glowing(const Eigen::Vector3d& light) {
  Finish f = plain({1, 1, 1}, 0, 0.5, 0.8);
  f.emissive = light;
  return f;
}

}  // namespace waretwin::builder
