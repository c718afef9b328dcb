// Pictures of a finished map: from above with cuboids and path, and from an oblique viewpoint.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "harness/pictures/rasteriser.h"
#include "harness/score/cuboid_file.h"
#include "harness/score/trajectory_file.h"

namespace waretwin {

struct MapScene {
  PictureMesh mesh;
  std::vector<std::int32_t> labels;  // map id of each vertex, 0 = background; empty: no objects are tinted
  std::vector<ListedObject> mapped;
  std::vector<ListedObject> truth;           // empty where there is none
  std::vector<StampedPose> trajectory;       // as estimated
  std::vector<StampedPose> true_trajectory;  // empty where there is none
};

// The mesh from above without what hangs higher than `ceiling` metres above the floor, true cuboids as outlines, mapped ones with their
// ids, the path, a legend and a scale bar. BGR, at most about 1600 pixels on the longer side.
cv::Mat draw_from_above(const MapScene& scene, double ceiling);

// The mesh from an oblique viewpoint outside, objects tinted by their ids, with their cuboids. BGR, 1280 x 720.
cv::Mat draw_oblique(const MapScene& scene, double ceiling);

}  // namespace waretwin
