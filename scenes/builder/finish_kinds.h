// Kinds of finishes: what painted, wooden, woven and glowing surfaces have in common. Finishes by name (finishes.h) are made of these.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "scenes/builder/model.h"

namespace waretwin::builder {

// Of one colour (sRGB in [0, 1]).
Finish plain(const Eigen::Vector3d& colour, double metallic, double roughness, double reflectivity);
// Of a texture that covers width x height metres and repeats.
Finish textured(const cv::Mat& texture, double width_m, double height_m, double metallic, double roughness, double reflectivity);
// Painted or powder-coated metal: fine grain, a little dirt, some scratches down to the metal.
Finish painted(const std::string& key, const cv::Scalar& bgr, double roughness, double reflectivity, int scratches = 25);
Finish wood(const std::string& key, const cv::Scalar& bgr, double contrast);
Finish fabric(const std::string& key, const cv::Scalar& bgr);  // a coarse weave
// A picture that is shown once and whole.
Finish picture_of(const cv::Mat& picture, double roughness = 0.5, double reflectivity = 0.7);
Finish screen(const cv::Mat& picture);  // one that glows
Finish glowing(const Eigen::Vector3d& light);

cv::Scalar bgr_of(const Eigen::Vector3d& srgb);  // 0-255

}  // namespace waretwin::builder
