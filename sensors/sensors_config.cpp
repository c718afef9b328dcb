#include "sensors/sensors_config.h"

namespace waretwin {

SensorsConfig SensorsConfig::of_the_paper() {
  SensorsConfig sensors;
  sensors.cameras["camera"] = CameraConfig::make("azure_kinect");
  sensors.lasers["laser"] = LaserConfig::make("sick_s300");
  return sensors;
}

void SensorsConfig::visit(Fields& f) {
  f.map("cameras", cameras, "colour and depth cameras by name");
  f.map("lasers", lasers, "laser scanners by name");
  f.group("odometry", odometry, "wheel odometry");
  // A sensor's name keys its errors.
  for (const auto& [name, camera] : cameras) {
    if (lasers.count(name) > 0) f.reject("lasers", "has '" + name + "', which is a camera's name already");
  }
}

}  // namespace waretwin
