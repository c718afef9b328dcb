// The pictures of one camera frame. Those of Renderer::render come from the same rays through the pixel centres, so they agree to the
// pixel; ColourCamera::look says what agrees with what in its own.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace waretwin {

// Names of classes in the order of their numbers in class images: 0 = background, then as the scene's objects first name them.
std::vector<std::string> class_names(const Scene& scene);

struct FrameImages {
  cv::Mat colour;     // CV_8UC3, BGR; empty when not asked for
  cv::Mat radiance;   // CV_32FC4, red, green, blue, 0: linear, times RenderOptions::exposure; empty when not asked for
  cv::Mat depth;      // CV_32FC1, metres along the optical axis, 0 = no surface
  cv::Mat instances;  // CV_16UC1, TrueObject::id, 0 = background
  cv::Mat classes;    // CV_16UC1, index into class_names(); empty when not asked for
  cv::Mat normals;    // CV_32FC3, unit, camera frame, towards the camera, zero where no surface; empty when not asked for
};

}  // namespace waretwin
