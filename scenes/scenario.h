// A scenario: which hall, what stands in it, how it is lit, which robot drives where with which sensors. One YAML file with its models
// beside it; file names are relative to the scenario's folder and may not leave it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/fields.h"
#include "core/pose.h"
#include "scenes/drive_config.h"
#include "scenes/motion_config.h"
#include "scenes/scene.h"
#include "scenes/waypoint.h"
#include "sensors/sensors_config.h"

namespace waretwin {

// A glTF file and where it stands. The file's origin goes to (x, y, z) in the world, its y axis up becomes z.
struct ModelPlacement {
  std::string name;            // for messages and objects; the file's stem where empty
  std::filesystem::path file;  // .gltf or .glb
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_deg = 0.0;
  double scale = 1.0;
  std::filesystem::path folder;  // of the scenario: when set, the file must exist (visit_model_file); not a key
  std::string class_name;  // key `class`: makes the whole model one object of this class; empty: the file's extras and `truth` rules decide
  void visit(Fields& f);
};

// Nodes whose name matches become objects of a class, beside those that the files' extras name ({"waretwin": {"class": "conveyor"}}).
struct TruthRule {
  std::string pattern;  // shell pattern: * and ?
  std::string class_name;
  void visit(Fields& f);
};

// A light of the scenario, beside those that the glTF files bring (KHR_lights_punctual).
struct LightConfig {
  std::string kind = "point";  // point, spot, directional
  std::vector<double> position_m = {0, 0, 3};
  std::vector<double> direction = {0, 0, -1};
  std::vector<double> colour = {1, 1, 1};  // linear RGB
  double intensity = 100.0;                // candela; directional: lux
  double radius_m = 0.1;                   // size of the emitter, makes soft shadows
  double inner_cone_deg = 30.0, outer_cone_deg = 45.0;
  void visit(Fields& f);
};

struct LightingConfig {
  std::vector<LightConfig> lights;
  std::vector<double> ambient = {0.3, 0.3, 0.3};        // radiance from all unblocked directions, linear RGB
  std::vector<double> background = {0.05, 0.05, 0.05};  // radiance of what lies beyond all surfaces
  double exposure = 1.0;                                // factor on radiance before the tone curve
  void visit(Fields& f);
};

struct RobotConfig {
  double length_m = 0.9, width_m = 0.6, height_m = 0.35;  // of the body, for clearance checks
  double speed_mps = 0.5;                                 // limits of the motion
  double acceleration_mps2 = 0.5;
  double turn_rate_deg_s = 45.0;
  double turn_acceleration_deg_s2 = 90.0;
  DriveConfig drive;
  std::filesystem::path model;  // glTF of the vehicle in its frame B (forward is x), seen by its own sensors; empty: they see nothing of it
  std::filesystem::path folder;  // of the scenario; see ModelPlacement
  std::vector<Waypoint> route;
  void visit(Fields& f);
};

struct Scenario {
  std::filesystem::path file;  // where it was read from; set by load_scenario
  std::string name;
  std::string description;
  std::uint64_t seed = 1;  // of all sensors and motion, never of the hall
  std::vector<ModelPlacement> models;
  std::vector<TruthRule> truth;
  LightingConfig lighting;
  RobotConfig robot;
  MotionConfig motion;
  SensorsConfig sensors;
  void visit(Fields& f);
};

// Reads a scenario and applies settings; checks that it names at least one model, a route of at least one waypoint and one camera or laser.
// Throws Error with file, line and key.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<Setting>& settings = {});

// Loads all models of a scenario into one scene in the world frame: instances, lights (files' and scenario's), the true objects with their
// cuboids, and what moves (Scene::movers). A truth node tilted more than 1 deg from upright is an Error, a truth node in what moves too.
Scene build_scene(const Scenario& scenario);

}  // namespace waretwin
