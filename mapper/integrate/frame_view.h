// What all integrators ask of a frame, and the space that it can tell about.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/pose.h"
#include "sensors/intrinsics.h"
#include "sensors/measurements.h"

namespace waretwin {

// Aborts where depth (CV_32FC1) and colour (CV_8UC3) are not of the intrinsics' size, or there are labels but not one a pixel.
void check_frame(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels);

// Lower and upper corner (world, metres) of the upright box around the viewing pyramid down to `depth` metres along the axis.
std::pair<Eigen::Vector3d, Eigen::Vector3d> viewing_box(const Intrinsics& intrinsics, const Pose& X_WC, double depth);

}  // namespace waretwin
