#include "scenes/scenario.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/own_name.h"
#include "scenes/gltf_loader.h"
#include "scenes/model_file.h"
#include "scenes/placing.h"

namespace waretwin {

namespace fs = std::filesystem;

void ModelPlacement::visit(Fields& f) {
  visit_model_file(f, file, folder);
  f("name", name, "for messages and objects; the file's stem where empty");
  f("x_m", x_m, "place of the file's origin in the world", {.min = -1e5, .max = 1e5});
  f("y_m", y_m, "place of the file's origin in the world", {.min = -1e5, .max = 1e5});
  f("z_m", z_m, "height of the file's origin above the floor", {.min = -1e4, .max = 1e4});
  f("yaw_deg", yaw_deg, "turned to the left about the file's origin", {.min = -360, .max = 360});
  f("scale", scale, "factor on all lengths of the file", {.min = 1e-4, .max = 1e4});
  f("class", class_name, "makes the whole model one object of this class");
}

void TruthRule::visit(Fields& f) {
  f("pattern", pattern, "nodes whose name matches become objects; * stands for any text, ? for one letter", {.required = true});
  f("class", class_name, "class of these objects", {.required = true});
  if (pattern.empty()) f.reject("pattern", "is empty; expected a pattern such as 'conveyor_*'");
  if (class_name.empty()) f.reject("class", "is empty; expected the name of a class");
}

void LightConfig::visit(Fields& f) {
  f("kind", kind, "shape of the light", {.choices = {"point", "spot", "directional"}});
  f("position_m", position_m, "place in the world; directional lights have none", {.min = -1e5, .max = 1e5, .length = 3});
  f("direction", direction, "where the light travels to; spot and directional", {.min = -1e3, .max = 1e3, .length = 3});
  f("colour", colour, "linear red, green and blue", {.min = 0, .max = 1e3, .length = 3});
  f("intensity", intensity, "candela; directional lights: lux", {.min = 0, .max = 1e6});
  f("radius_m", radius_m, "size of the emitter, makes soft shadows", {.min = 0, .max = 10});
  f("inner_cone_deg", inner_cone_deg, "spot: half angle of full brightness", {.min = 0, .max = 90});
  f("outer_cone_deg", outer_cone_deg, "spot: half angle beyond which there is no light", {.min = 0, .max = 90});
  const bool has_length = std::any_of(direction.begin(), direction.end(), [](double v) { return std::abs(v) > 1e-9; });
  if (!has_length) f.reject("direction", "has no length; expected where the light travels to");
  if (kind == "spot" && inner_cone_deg >= outer_cone_deg) f.reject("outer_cone_deg", "must be greater than inner_cone_deg");
}

void LightingConfig::visit(Fields& f) {
  f.list("lights", lights, "lights beside those in the models");
  f("ambient", ambient, "radiance from all unblocked directions, linear red, green and blue", {.min = 0, .max = 1e6, .length = 3});
  f("background", background, "radiance of what lies beyond all surfaces", {.min = 0, .max = 1e6, .length = 3});
  f("exposure", exposure, "factor on radiance before the tone curve", {.min = 1e-6, .max = 1e6});
}

void RobotConfig::visit(Fields& f) {
  f("length_m", length_m, "length of the body", {.min = 0.05, .max = 20});
  f("width_m", width_m, "width of the body", {.min = 0.05, .max = 20});
  f("height_m", height_m, "height of the body", {.min = 0.05, .max = 20});
  f("speed_mps", speed_mps, "largest speed", {.min = 0.01, .max = 10});
  f("acceleration_mps2", acceleration_mps2, "largest acceleration and braking", {.min = 0.01, .max = 20});
  f("turn_rate_deg_s", turn_rate_deg_s, "largest rate of turn", {.min = 0.5, .max = 720});
  f("turn_acceleration_deg_s2", turn_acceleration_deg_s2, "largest change of the rate of turn", {.min = 0.5, .max = 7200});
  f.group("drive", drive, "how it rolls");
  visit_optional_model(
      f, "model", model, folder,
      "glTF file of the vehicle (forward is x, origin on the floor under its middle), seen by its own sensors; empty: none");
  f.list("route", route, "waypoints in the order in which the vehicle visits them", {.required = true});
  if (route.empty()) f.reject("route", "has no waypoint; expected at least one");
}

void Scenario::visit(Fields& f) {
  f("name", name, "short name for reports; the folder's name where empty");
  f("description", description, "one line for people");
  f("seed", seed, "of all sensors and motion, never of the hall");
  f.list("models", models, "glTF files and where they stand", {.required = true});
  f.list("truth", truth, "nodes that become objects by their names");
  f.group("lighting", lighting, "light in the hall");
  f.group("robot", robot, "the vehicle and its route", {.required = true});
  f.group("motion", motion, "what moves in the hall");
  f.group("sensors", sensors, "what the vehicle carries");
  if (models.empty()) f.reject("models", "is empty; expected at least one model");
  if (sensors.cameras.empty() && sensors.lasers.empty()) f.reject("sensors", "has neither a camera nor a laser");
}

namespace {

Light light_from(const LightConfig& config, std::size_t index) {
  Light light;
  light.name = "scenario light " + std::to_string(index);
  light.kind = config.kind == "point" ? Light::Kind::kPoint : config.kind == "spot" ? Light::Kind::kSpot : Light::Kind::kDirectional;
  light.position = Eigen::Vector3d(config.position_m.data()).cast<float>();
  light.direction = Eigen::Vector3d(config.direction.data()).normalized().cast<float>();
  light.intensity = (config.intensity * Eigen::Vector3d(config.colour.data())).cast<float>();
  light.inner_cone = static_cast<float>(to_radians(config.inner_cone_deg));
  light.outer_cone = static_cast<float>(to_radians(config.outer_cone_deg));
  light.radius = static_cast<float>(config.radius_m);
  return light;
}

// Lists of numbers have 3 entries when they come from a file; a program may have set others.
void check_lighting(const LightingConfig& lighting) {
  WARETWIN_CHECK(lighting.ambient.size() == 3 && lighting.background.size() == 3, "light has three components");
  for (const LightConfig& light : lighting.lights) {
    WARETWIN_CHECK(light.position_m.size() == 3 && light.direction.size() == 3 && light.colour.size() == 3,
                   "vectors have three components");
  }
}

}  // namespace

Scenario load_scenario(const fs::path& file, const std::vector<Setting>& settings) {
  Scenario scenario;
  scenario.file = file;
  const auto visit = [&](Fields& f) { scenario.visit(f); };
  read_config(file, visit);
  // A placement judges its file where the reader knows the line, so it must know the folder by then; how many placements there are is only
  // known after reading. Hence once more.
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (ModelPlacement& placement : scenario.models) placement.folder = folder;
  scenario.motion.set_folder(folder);
  scenario.robot.folder = folder;
  read_config(file, visit);
  if (!settings.empty()) apply_settings(settings, visit);
  if (scenario.name.empty()) scenario.name = own_name(file.parent_path());
  return scenario;
}

Scene build_scene(const Scenario& scenario) {
  check_lighting(scenario.lighting);
  SceneBuilder builder(scenario.truth);
  std::map<fs::path, Model> loaded;
  const auto model_of = [&](const fs::path& name) -> const Model& {
    const fs::path file = scenario.file.parent_path() / name;
    auto found = loaded.find(file);
    if (found == loaded.end()) found = loaded.emplace(file, load_model(file)).first;
    return found->second;
  };
  for (const ModelPlacement& placement : scenario.models) {
    Placing placing;
    placing.X_WP = make_upright_pose(placement.x_m, placement.y_m, placement.z_m, to_radians(placement.yaw_deg));
    placing.X_WP.scale(placement.scale);
    placing.class_name = placement.class_name;
    placing.name = placement.name.empty() ? placement.file.stem().string() : placement.name;
    builder.place(model_of(placement.file), placing);
  }
  const auto add_movers = [&](const fs::path& file, const std::string& name, int count) {
    for (int i = 0; i < count; ++i) builder.add_mover(model_of(file), name.empty() ? file.stem().string() : name);
  };
  for (const ItemStream& stream : scenario.motion.streams) add_movers(stream.body.file, stream.name, stream.most);
  for (const ClutterConfig& thing : scenario.motion.clutter) add_movers(thing.body.file, thing.name, thing.count);
  for (const WalkerConfig& walker : scenario.motion.walkers) add_movers(walker.file, walker.name, 1);
  for (const HeldConfig& thing : scenario.motion.held) {
    add_movers(thing.file, thing.name, 1);
    if (!thing.stand.empty()) add_movers(thing.stand, "", 1);
  }
  if (!scenario.robot.model.empty()) builder.add_vehicle(model_of(scenario.robot.model));
  for (std::size_t i = 0; i < scenario.truth.size(); ++i) {
    if (builder.matched()[i] > 0) continue;
    throw Error(scenario.file, "truth." + std::to_string(i) + ".pattern '" + scenario.truth[i].pattern + "' matches no node of any model");
  }
  Scene scene = builder.finish();
  scene.name = scenario.name;
  for (std::size_t i = 0; i < scenario.lighting.lights.size(); ++i) scene.lights.push_back(light_from(scenario.lighting.lights[i], i));
  scene.ambient = Eigen::Vector3d(scenario.lighting.ambient.data()).cast<float>();
  scene.background = Eigen::Vector3d(scenario.lighting.background.data()).cast<float>();
  return scene;
}

}  // namespace waretwin
