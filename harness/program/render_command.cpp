// waretwin render: one picture from any pose.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/picture_file.h"
#include "harness/program/common_options.h"
#include "scenes/gltf_loader.h"
#include "scenes/scenario.h"
#include "sim/motion/hall_motion.h"
#include "sim/still.h"

namespace waretwin {

namespace {

struct RenderCommandOptions {
  CommonOptions common;
  std::string source, out, pose, size, quality = "fast";
  std::optional<double> time_s;
  int samples = 0;
};

// What is rendered and from where, unless the command line says otherwise.
struct View {
  std::shared_ptr<RayCaster> hall;
  Intrinsics intrinsics;
  Pose X_WC = Pose::Identity();
  std::uint64_t seed = 1;
  double exposure = 1.0;
};

std::vector<double> numbers(const std::string& option, const std::string& text, char separator, std::size_t least, std::size_t most) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double value = 0.0;
    const auto [next, status] = std::from_chars(at, end, value);
    if (status != std::errc() || !std::isfinite(value))
      throw Error(option + " " + text + ": expected numbers joined by '" + separator + "'");
    values.push_back(value);
    if (next == end) break;
    if (*next != separator) throw Error(option + " " + text + ": expected numbers joined by '" + separator + "'");
    at = next + 1;
  }
  if (values.size() < least || values.size() > most) {
    throw Error(option + " " + text + ": has " + std::to_string(values.size()) + " numbers, expected " + std::to_string(least) +
                (most > least ? " to " + std::to_string(most) : ""));
  }
  return values;
}

Pose looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  Pose X = Pose::Identity();
  X.translation() = eye;
  const double yaw = std::atan2(forward.y(), forward.x()), pitch = -std::asin(forward.z());
  X.linear() = rotation_from_rpy(0.0, pitch, yaw) * optical_from_forward();
  return X;
}

View view_of_model(const RenderCommandOptions& options) {
  if (options.time_s) throw Error("--time: " + options.source + " is a model, nothing drives in it; only scenarios have a time");
  View view;
  Scene scene = load_gltf(options.source);
  if (scene.lights.empty()) {
    // A model by itself is often unlit: daylight from the side, so that its shape can be seen.
    Light sun;
    sun.kind = Light::Kind::kDirectional;
    sun.direction = Eigen::Vector3f(0.4f, 0.5f, -1.0f).normalized();
    sun.intensity = Eigen::Vector3f::Constant(2.0f);
    scene.lights.push_back(sun);
    scene.ambient = Eigen::Vector3f::Constant(0.5f);
  } else {
    scene.ambient = Eigen::Vector3f::Constant(0.3f);
  }
  scene.background = Eigen::Vector3f::Constant(0.6f);
  const Eigen::AlignedBox3f bounds = scene.bounds();
  if (bounds.isEmpty()) throw Error(options.source + ": holds no triangles");
  const Eigen::Vector3d centre = bounds.center().cast<double>();
  const double reach = std::max(0.01, static_cast<double>(bounds.diagonal().norm()));
  const Eigen::Vector3d half = 0.5 * bounds.sizes().cast<double>();
  // A hall is looked at from a corner inside, below its lamps; anything smaller from outside.
  constexpr double kSmallestHall = 4.0;  // metres
  const bool hall = half.x() > 0.5 * kSmallestHall && half.y() > 0.5 * kSmallestHall;
  const Eigen::Vector3d inside = centre + Eigen::Vector3d(-0.85 * half.x(), -0.7 * half.y(), 0.6 * half.z());
  view.X_WC = looking_at(hall ? inside : centre + 1.1 * reach * Eigen::Vector3d(-0.6, -0.8, 0.55).normalized(),
                         hall ? Eigen::Vector3d(centre.x(), centre.y(), bounds.min().z()) : centre);
  view.intrinsics = Intrinsics::from_field_of_view(1280, 720, to_radians(75.0), 2.0 * std::atan(std::tan(to_radians(37.5)) * 9.0 / 16.0));
  view.hall = std::make_shared<RayCaster>(std::make_shared<const Scene>(std::move(scene)));
  return view;
}

View view_of_scenario(const RenderCommandOptions& options, const std::vector<Setting>& settings) {
  const Scenario scenario = load_scenario(options.source, settings);
  View view;
  view.hall = std::make_shared<RayCaster>(std::make_shared<const Scene>(build_scene(scenario)));
  view.seed = scenario.seed;
  view.exposure = scenario.lighting.exposure;
  HallMotion motion(scenario, *view.hall);
  const double end_s = to_seconds(motion.duration());
  if (options.time_s && !(*options.time_s >= 0.0 && *options.time_s <= end_s)) {
    throw Error("--time " + std::to_string(*options.time_s) + ": the route takes " + std::to_string(end_s) + " s; expected 0 to that");
  }
  CameraConfig camera;
  if (!scenario.sensors.cameras.empty()) camera = scenario.sensors.cameras.begin()->second;
  view.intrinsics = camera.intrinsics();
  const Stamp moment = from_seconds(options.time_s.value_or(0.0));
  motion.advance_to(moment);
  motion.moment(moment, moment).show(*view.hall);
  view.X_WC = motion.X_WB(moment) * camera.mount.X_BC();
  return view;
}

int render(const RenderCommandOptions& options) {
  options.common.apply();
  if (std::filesystem::path(options.out).extension() != ".png") throw Error("--out " + options.out + ": expected a name that ends in .png");
  RenderOptions how;
  how.quality = options.quality;
  if (options.samples > 0) how.samples = options.samples;
  std::vector<Setting> render_settings, scenario_settings;
  if (options.common.seed) scenario_settings.push_back({"seed", std::to_string(*options.common.seed)});
  for (const Setting& setting : options.common.settings()) {
    (setting.key.starts_with("render.") ? render_settings : scenario_settings).push_back(setting);
  }
  struct {
    RenderOptions& how;
    void visit(Fields& f) { f.group("render", how, "how pictures are made"); }
  } tree{how};
  apply_settings(render_settings, [&](Fields& f) { tree.visit(f); });

  const std::string extension = std::filesystem::path(options.source).extension().string();
  const bool model = extension == ".glb" || extension == ".gltf";
  View view = model ? view_of_model(options) : view_of_scenario(options, scenario_settings);
  how.exposure *= view.exposure;
  if (!options.pose.empty()) {
    const std::vector<double> p = numbers("--pose", options.pose, ',', 5, 6);
    const Mount place{.x_m = p[0], .y_m = p[1], .z_m = p[2], .yaw_deg = p[3], .pitch_deg = p[4], .roll_deg = p.size() > 5 ? p[5] : 0.0};
    view.X_WC = place.X_BC();
  }
  if (!options.size.empty()) {
    const std::vector<double> size = numbers("--size", options.size, 'x', 2, 2);
    const double scale = size[0] / view.intrinsics.width;
    if (!(size[0] >= 1.0 && size[0] <= 16384.0 && size[1] >= 1.0 && size[1] <= 16384.0)) {
      throw Error("--size " + options.size + ": expected WIDTHxHEIGHT, each 1 to 16384");
    }
    // The horizontal field of view stays.
    view.intrinsics = Intrinsics::checked(static_cast<int>(size[0]), static_cast<int>(size[1]), view.intrinsics.fx * scale,
                                          view.intrinsics.fy * scale, 0.5 * (size[0] - 1.0), 0.5 * (size[1] - 1.0));
  }
  const StillPicture picture = render_still(view.hall, view.intrinsics, view.X_WC, how, options.common.seed.value_or(view.seed));
  if (const auto parent = std::filesystem::path(options.out).parent_path(); !parent.empty()) make_folder(parent);
  write_png(options.out, picture.colour);
  return 0;
}

}  // namespace

Command add_render_command(CLI::App& program) {
  auto options = std::make_shared<RenderCommandOptions>();
  CLI::App* command = program.add_subcommand("render", "one picture of a hall or a model from any pose");
  command->add_option("SCENARIO", options->source, "scenario file, or a .glb or .gltf model")->required();
  command->add_option("--out", options->out, "picture to write")->required()->type_name("PNG");
  command
      ->add_option("--time", options->time_s, "what the robot's camera sees after S seconds, and where everything stands then (default 0)")
      ->type_name("S");
  command
      ->add_option("--pose", options->pose,
                   "camera in the world in place of the robot's: metres, then degrees to the left, downwards, to the right")
      ->type_name("X,Y,Z,YAW,PITCH[,ROLL]");
  command->add_option("--quality", options->quality, "fast, or path: bounced light")
      ->capture_default_str()
      ->check(CLI::IsMember({"fast", "path"}));
  command->add_option("--samples", options->samples, "per pixel, for path")->type_name("N")->check(CLI::Range(1, 65536));
  command->add_option("--size", options->size, "pixels; the horizontal field of view stays")->type_name("WxH");
  options->common.add_to(*command);
  command->footer(
      "Examples:\n  waretwin render scenes/agiprobot/scenario.yaml --out view.png --time 12\n"
      "  waretwin render scenes/agiprobot/scenario.yaml --out hall.png --pose=-5.2,-2.2,2.6,24,22 --quality path --samples 64\n"
      "  waretwin render model.glb --out model.png --size 800x600");
  return {command, [options] { return render(*options); }};
}

}  // namespace waretwin
