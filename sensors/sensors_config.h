// All sensors of a vehicle, by name.
#pragma once

#include <map>
#include <string>

#include "sensors/camera_config.h"
#include "sensors/laser_config.h"
#include "sensors/odometry_config.h"

namespace waretwin {

struct SensorsConfig {
  std::map<std::string, CameraConfig> cameras;
  std::map<std::string, LaserConfig> lasers;
  OdometryConfig odometry;

  // The vehicle of the paper: an Azure Kinect called "camera", a SICK S300 called "laser".
  static SensorsConfig of_the_paper();
  void visit(Fields& f);
};

}  // namespace waretwin
