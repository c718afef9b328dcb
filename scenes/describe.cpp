#include "scenes/describe.h"

#include <cmath>

#include "core/add_line.h"
#include "core/pose.h"

namespace waretwin {

namespace {

// What one list shows; halls have hundreds of materials.
constexpr std::size_t kLongestList = 40;

template <class T, class AddOne>
void add_list(std::string& text, const char* title, const std::vector<T>& values, const AddOne& add_one) {
  if (values.empty()) return;
  add_line(text, "%s:", title);
  for (std::size_t i = 0; i < values.size() && i < kLongestList; ++i) add_one(values[i]);
  if (values.size() > kLongestList) add_line(text, "  and %zu more", values.size() - kLongestList);
}

const char* shown(const std::string& name) { return name.empty() ? "(no name)" : name.c_str(); }

void add_material(std::string& text, const Scene& scene, const Material& m) {
  std::string uses;
  const auto add_use = [&](const char* what, const TextureUse& use) {
    if (use.texture < 0) return;
    uses += std::string(uses.empty() ? "; " : ", ") + what + " '" + scene.textures[static_cast<std::size_t>(use.texture)].name + "'";
  };
  add_use("colour", m.base_colour_texture);
  add_use("metallic-roughness", m.metallic_roughness_texture);
  add_use("normals", m.normal_texture);
  add_use("emission", m.emissive_texture);
  if (m.emissive.norm() > 0.0f) uses += ", emissive";
  if (m.alpha_mask) uses += ", alpha mask";
  if (m.double_sided) uses += ", double-sided";
  if (!std::isnan(m.reflectivity_850nm)) uses += ", reflectivity at 850 nm " + std::to_string(m.reflectivity_850nm).substr(0, 4);
  if (m.retroreflection > 0.0f) uses += ", retroreflective " + std::to_string(static_cast<int>(std::lround(m.retroreflection)));
  add_line(text, "  %.80s: rgba %.2f %.2f %.2f %.2f, metallic %.2f, roughness %.2f%.600s", shown(m.name),
           static_cast<double>(m.base_colour[0]), static_cast<double>(m.base_colour[1]), static_cast<double>(m.base_colour[2]),
           static_cast<double>(m.base_colour[3]), static_cast<double>(m.metallic), static_cast<double>(m.roughness), uses.c_str());
}

void add_light(std::string& text, const Light& light) {
  const char* kind = light.kind == Light::Kind::kPoint ? "point" : light.kind == Light::Kind::kSpot ? "spot" : "directional";
  const Eigen::Vector3d p = light.position.cast<double>(), d = light.direction.cast<double>();
  const Eigen::Vector3d i = light.intensity.cast<double>();
  std::string where;
  char part[120];
  if (light.kind != Light::Kind::kDirectional) {
    std::snprintf(part, sizeof part, " at (%.2f, %.2f, %.2f)", p.x(), p.y(), p.z());
    where += part;
  }
  if (light.kind != Light::Kind::kPoint) {
    std::snprintf(part, sizeof part, " towards (%.2f, %.2f, %.2f)", d.x(), d.y(), d.z());
    where += part;
  }
  add_line(text, "  %.80s: %s%s, %.4g %.4g %.4g %s, radius %.2f m", shown(light.name), kind, where.c_str(), i.x(), i.y(), i.z(),
           light.kind == Light::Kind::kDirectional ? "lux" : "cd", static_cast<double>(light.radius));
}

void add_object(std::string& text, const TrueObject& object) {
  const Cuboid& c = object.cuboid;
  add_line(text, "  %d %.40s '%.80s': centre (%.3f, %.3f, %.3f) m, yaw %.1f deg, size %.3f x %.3f x %.3f m", object.id,
           object.class_name.c_str(), object.name.c_str(), c.centre.x(), c.centre.y(), c.centre.z(), to_degrees(c.yaw), c.size.x(),
           c.size.y(), c.size.z());
}

void add_motion(std::string& text, const MotionConfig& motion) {
  add_list(text, "belts", motion.belts, [&](const BeltConfig& belt) {
    const std::string way = belt.curve ? "about its pivot" : "towards " + std::to_string(std::lround(belt.heading_deg)) + " deg";
    add_line(text, "  %.80s: %.3g m/s %s, %zu changes", belt.object.c_str(), belt.speed_mps, way.c_str(), belt.changes.size());
  });
  add_list(text, "streams", motion.streams, [&](const ItemStream& stream) {
    add_line(text, "  %.80s: %.200s of %.3g kg every %.4g s from %.4g s on, at most %d, at (%.2f, %.2f, %.2f) m", shown(stream.name),
             stream.body.file.c_str(), stream.body.mass_kg, stream.every_s, stream.first_s, stream.most, stream.x_m, stream.y_m,
             stream.z_m);
  });
  if (!motion.sinks.empty()) add_line(text, "sinks: %zu", motion.sinks.size());
  add_list(text, "clutter", motion.clutter, [&](const ClutterConfig& thing) {
    add_line(text, "  %d x %.80s: %.200s at (%.2f, %.2f) m", thing.count, shown(thing.name), thing.body.file.c_str(), thing.x_m, thing.y_m);
  });
  add_list(text, "walkers", motion.walkers, [&](const WalkerConfig& walker) {
    add_line(text, "  %.80s: %.200s, %zu places, at most %.3g m/s", shown(walker.name), walker.file.c_str(), walker.path.size(),
             walker.speed_mps);
  });
  add_list(text, "held", motion.held, [&](const HeldConfig& thing) {
    add_line(text, "  %.80s: %.200s in %zu places, %.4g s in each", shown(thing.name), thing.file.c_str(), thing.places.size(),
             thing.hold_s);
  });
}

}  // namespace

std::string describe_scene(const Scene& scene) {
  std::string text;
  std::size_t stored = 0, vertices = 0, texels = 0;
  for (const Mesh& mesh : scene.meshes) {
    stored += mesh.triangles.size() / 3;
    vertices += mesh.positions.size();
  }
  for (const Texture& texture : scene.textures) texels += texture.rgba.size();
  add_line(text, "scene: %.200s", shown(scene.name));
  add_line(text, "triangles: %zu (%zu stored in %zu meshes with %zu vertices, %zu instances)", scene.triangle_count(), stored,
           scene.meshes.size(), vertices, scene.instances.size());
  const Eigen::AlignedBox3f box = scene.bounds();
  if (box.isEmpty()) {
    add_line(text, "bounds: empty");
  } else {
    const Eigen::Vector3d low = box.min().cast<double>(), high = box.max().cast<double>();
    add_line(text, "bounds: (%.3f, %.3f, %.3f) to (%.3f, %.3f, %.3f) m, z up", low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  }
  add_line(text, "counts: %zu materials, %zu textures (%.1f MB), %zu lights, %zu objects", scene.materials.size(), scene.textures.size(),
           static_cast<double>(texels) / 1e6, scene.lights.size(), scene.objects.size());
  add_list(text, "objects", scene.objects, [&](const TrueObject& object) { add_object(text, object); });
  add_list(text, "materials", scene.materials, [&](const Material& material) { add_material(text, scene, material); });
  add_list(text, "textures", scene.textures,
           [&](const Texture& texture) { add_line(text, "  %.200s: %d x %d", shown(texture.name), texture.width, texture.height); });
  add_list(text, "lights", scene.lights, [&](const Light& light) { add_light(text, light); });
  add_list(text, "notes", scene.notes, [&](const std::string& note) { add_line(text, "  %.400s", note.c_str()); });
  return text;
}

std::string describe_scenario(const Scenario& scenario) {
  std::string text;
  add_line(text, "scenario: %.200s (%.400s)", shown(scenario.name), scenario.file.c_str());
  if (!scenario.description.empty()) add_line(text, "description: %.600s", scenario.description.c_str());
  add_line(text, "seed: %llu", static_cast<unsigned long long>(scenario.seed));
  add_list(text, "models", scenario.models, [&](const ModelPlacement& m) {
    add_line(text, "  %.200s at (%.3f, %.3f, %.3f) m, yaw %.1f deg, scale %g", m.file.c_str(), m.x_m, m.y_m, m.z_m, m.yaw_deg, m.scale);
  });
  double length = 0.0;
  for (std::size_t i = 1; i < scenario.robot.route.size(); ++i) {
    const Waypoint &a = scenario.robot.route[i - 1], &b = scenario.robot.route[i];
    length += std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  }
  add_line(text, "route: %zu waypoints, %.1f m; robot %.2f x %.2f x %.2f m, at most %.2f m/s", scenario.robot.route.size(), length,
           scenario.robot.length_m, scenario.robot.width_m, scenario.robot.height_m, scenario.robot.speed_mps);
  const DriveConfig& drive = scenario.robot.drive;
  add_line(text, "drive: %.20s, %.4g kg and %.4g kg of load", drive.model.c_str(), drive.mass_kg, drive.payload_kg);
  add_motion(text, scenario.motion);
  for (const auto& [name, camera] : scenario.sensors.cameras) {
    add_line(text, "camera %.80s: %.40s, %d x %d at %.4g Hz, %.2f m high, %.1f deg down", name.c_str(), camera.preset.c_str(), camera.width,
             camera.height, camera.rate_hz, camera.mount.z_m, camera.mount.pitch_deg);
  }
  for (const auto& [name, laser] : scenario.sensors.lasers) {
    add_line(text, "laser %.80s: %.40s, %d beams over %.4g deg at %.4g Hz, %.2f m high", name.c_str(), laser.preset.c_str(), laser.beams,
             laser.field_deg, laser.rate_hz, laser.mount.z_m);
  }
  return text + describe_scene(build_scene(scenario));
}

}  // namespace waretwin
