// The vehicles that drive through generated halls, and what they see with.
#pragma once

#include <string>

#include "scenes/scenario.h"
#include "sensors/camera_config.h"

namespace waretwin::generate {

struct Vehicle {
  RobotConfig robot;    // without a route
  std::string sensors;  // as it stands in a scenario, with comments
  CameraConfig camera;  // what the text says of the camera `camera`
};

// The paper's mapping vehicle; in a `home` a slim one with an RGB-D camera at eye height, as rooms of SceneNN were scanned.
Vehicle vehicle_of(const std::string& style);

}  // namespace waretwin::generate
