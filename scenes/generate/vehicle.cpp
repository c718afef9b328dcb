#include "scenes/generate/vehicle.h"

#include "core/config.h"
#include "sensors/sensors_config.h"

namespace waretwin::generate {

namespace {

constexpr const char* kPaper =
    "# The vehicle's sensors by name. A preset stands for a product's data sheet; any of its values can be set beside it.\n"
    "sensors:\n  cameras:\n    camera:\n      preset: azure_kinect\n      rate_hz: 15\n"
    "      # On the vehicle's centre, 1.4 m high, looking forward and 45 degrees down.\n"
    "      mount: {x_m: 0.0, y_m: 0.0, z_m: 1.4, pitch_deg: 45}\n"
    "  lasers:\n    laser:\n      preset: sick_s300\n"
    "      # At the front left corner, level, 0.3 m above the floor.\n"
    "      mount: {x_m: 0.275, y_m: 0.2, z_m: 0.3, yaw_deg: 43.9}\n"
    "  odometry:\n    rate_hz: 50\n";

constexpr const char* kHome =
    "# The vehicle's sensors by name. A preset stands for a product's data sheet; any of its values can be set beside it.\n"
    "sensors:\n  cameras:\n    camera:\n"
    "      # With the picture, field, range and noise of the hand-held cameras that SceneNN was made with.\n"
    "      preset: realsense_d435\n      stereo: {subpixel_px: 0.03}\n      width: 640\n      height: 480\n      horizontal_fov_deg: 58\n  "
    "    vertical_fov_deg: 45\n"
    "      field: {horizontal_deg: 58, vertical_deg: 45}\n      depth_min_m: 0.5\n      depth_max_m: 4.0\n      rate_hz: 30\n"
    "      # At eye height, looking forward and 25 degrees down.\n"
    "      mount: {x_m: 0.0, y_m: 0.0, z_m: 1.45, pitch_deg: 25}\n"
    "  lasers:\n    laser:\n      preset: sick_s300\n"
    "      # In front, level, 0.2 m above the floor.\n"
    "      mount: {x_m: 0.1, y_m: 0.0, z_m: 0.2}\n"
    "  odometry:\n    rate_hz: 50\n";

}  // namespace

Vehicle vehicle_of(const std::string& style) {
  Vehicle vehicle;
  vehicle.sensors = kPaper;
  if (style == "home") {
    vehicle.sensors = kHome;
    vehicle.robot.length_m = 0.45;
    vehicle.robot.width_m = 0.40;
    vehicle.robot.height_m = 0.30;
    vehicle.robot.turn_rate_deg_s = 50.0;
    vehicle.robot.drive.mass_kg = 30.0;
    vehicle.robot.drive.track_m = 0.34;
  }
  SensorsConfig sensors;
  read_config_text(vehicle.sensors, "vehicle of style " + style, [&](Fields& f) { f.group("sensors", sensors, "of the vehicle"); });
  vehicle.camera = sensors.cameras.at("camera");
  return vehicle;
}

}  // namespace waretwin::generate
