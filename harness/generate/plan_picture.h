// A hall from above with its conveyors and the vehicle's route.
#pragma once

#include <opencv2/core/mat.hpp>

#include "harness/pictures/rasteriser.h"
#include "scenes/scenario.h"
#include "scenes/scene.h"

namespace waretwin {

// The hall without its ceiling, true cuboids as outlines with their ids, the route as a line, stops as arrows where the camera looks, the
// start as a ring, and a scale bar. BGR, at most about 1600 pixels on the longer side.
cv::Mat draw_plan(const Scene& scene, const RobotConfig& robot);

// Where the plan's pixels lie in the hall.
PictureView plan_view(const Scene& scene);

}  // namespace waretwin
