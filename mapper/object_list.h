// The mapped objects: the paper's < Frame_ID, Mapped_ID, Class, bbox, T, R(theta), D, HSV, 3D points, ... > (section 3.3).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

#include "core/cuboid.h"

namespace waretwin {

struct MappedObject {
  int id = 0;  // Mapped_ID, from 1; 0 is the background
  std::string class_name;
  Cuboid cuboid;                          // frame "world"
  float score = 1.0f;                     // of the last detection
  int first_frame = 0, last_frame = 0;    // Frame_ID: counts mapped frames
  int observations = 0;                   // frames in which it was associated
  cv::Rect2f box;                         // 2D box in the last of them
  std::vector<float> hsv;                 // colour histogram in the last of them
  std::vector<Eigen::Vector3f> points_W;  // accumulated (thinned, where the profile thins)
};

using ObjectList = std::vector<MappedObject>;

}  // namespace waretwin
