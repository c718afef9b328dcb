#include "harness/dataset/hall_photographer.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/dice.h"
#include "core/error.h"
#include "harness/dataset/appearance.h"
#include "harness/dataset/things.h"
#include "harness/dataset/view_sampler.h"
#include "sim/colour_camera.h"
#include "sim/motion/hall_motion.h"
#include "sim/object_views.h"
#include "sim/renderer.h"

namespace waretwin {

namespace {

constexpr const char* kSensor = "dataset";
constexpr Stamp kBetween = 700'000'000;  // of the hall's time, from picture to picture
constexpr double kLatestStart_s = 20.0;  // the hall's time at the first one
constexpr int kTriesForEmpty = 6;
constexpr double kWidestField_deg = 170.0;

Dice dice_for(const DatasetConfig& config, const char* purpose, int number) {
  return Dice(RandomStream(config.seed, kSensor, purpose, number));
}

Hall varied(const Hall& hall, const DatasetConfig& config, int number) {
  Hall out = hall;
  auto scene = std::make_shared<Scene>(*hall.scene);
  Dice light = dice_for(config, "light", number), materials = dice_for(config, "materials", number),
       things = dice_for(config, "things", number);
  vary_light(*scene, config.light, light);
  vary_materials(*scene, config.materials, materials);
  add_things(*scene, out.scenario, config.things, things);
  out.scene = std::move(scene);
  // The vehicle is not in its own pictures, so that it need not be rolled along its route.
  out.scenario.robot.drive.model = "exact";
  return out;
}

CameraConfig varied_camera(const Hall& hall, const CameraVariation& config, Dice& dice) {
  const auto& cameras = hall.scenario.sensors.cameras;
  const auto found = config.name.empty() ? cameras.begin() : cameras.find(config.name);
  WARETWIN_CHECK(found != cameras.end(), "whoever makes a set has asked its halls for the camera");
  CameraConfig camera = found->second;
  const double field = 1.0 + dice.between(-config.field_share, config.field_share);
  // What a camera may be set to (camera_config.cpp), so that a wide one does not become none.
  const auto wider = [field](double fov_deg) { return std::min(field * fov_deg, std::max(fov_deg, kWidestField_deg)); };
  camera.horizontal_fov_deg = wider(camera.horizontal_fov_deg);
  camera.vertical_fov_deg = wider(camera.vertical_fov_deg);
  camera.mount.x_m += dice.between(-config.place_m, config.place_m);
  camera.mount.y_m += dice.between(-config.place_m, config.place_m);
  camera.mount.z_m += dice.between(-config.height_m, config.height_m);
  camera.mount.pitch_deg += dice.between(-config.pitch_deg, config.pitch_deg);
  camera.mount.yaw_deg += dice.between(-config.yaw_deg, config.yaw_deg);
  const double sensitivity = dice.stops(config.noise_stops);
  camera.colour.sensitivity_e_per_s *= sensitivity;
  camera.colour.full_well_e *= sensitivity;
  return camera;
}

}  // namespace

struct HallPhotographer::State {
  State(const Hall& a_hall, const DatasetConfig& a_config, const std::vector<std::string>& a_classes, int a_number)
      : config(a_config),
        classes(a_classes),
        number(a_number),
        dice(dice_for(config, "camera", number)),
        hall(varied(a_hall, config, number)),
        camera_config(varied_camera(hall, config.camera, dice)),
        lens(camera_config.view()),
        ray_caster(std::make_shared<RayCaster>(hall.scene, RayCasterOptions{.isa = config.isa})),
        renderer(ray_caster,
                 [&] {
                   RenderOptions options = config.render;
                   options.exposure *= hall.scenario.lighting.exposure * dice.stops(config.camera.exposure_stops);
                   return options;
                 }()),
        camera(camera_config, RandomStream(config.seed, kSensor, "errors", number).words(0)[0], kSensor, renderer) {
    if (!hall.scene->movers.empty()) motion.emplace(hall.scenario, *ray_caster);
    if (!a_hall.scene->movers.empty()) now = from_seconds(dice.between(0.0, kLatestStart_s));
  }

  DatasetConfig config;
  std::vector<std::string> classes;
  int number;
  Dice dice;
  Hall hall;
  CameraConfig camera_config;
  Lens lens;  // of its pictures
  std::shared_ptr<RayCaster> ray_caster;
  Renderer renderer;
  ColourCamera camera;
  std::optional<HallMotion> motion;
  Stamp now = 0;  // the hall's time

  Photograph take(const View& view, int index);
};

HallPhotographer::HallPhotographer(const Hall& hall, const DatasetConfig& config, const std::vector<std::string>& classes, int number)
    : state_(std::make_unique<State>(hall, config, classes, number)) {}

HallPhotographer::~HallPhotographer() = default;

Photograph HallPhotographer::take(int index) {
  State& s = *state_;
  s.now += kBetween;
  const Stamp reach = s.camera.half_span();
  if (s.motion) {
    s.motion->advance_to(s.now + reach);
    s.motion->moment(s.now - reach, s.now + reach).show(*s.ray_caster);
  }
  const ViewSampler views(*s.ray_caster, s.hall.scenario, s.camera_config.intrinsics(), s.camera_config.mount.X_BC(), s.config.views,
                          s.classes);
  Dice dice = dice_for(s.config, "view", index);
  ViewKind kind = views.draw_kind(dice);
  for (int tried = 0;; ++tried) {
    std::optional<View> view = views.draw(kind, dice);
    if (!view) {
      kind = ViewKind::kRoute;
      view = views.draw(kind, dice);
    }
    Photograph photograph = s.take(*view, index);
    // The sampler looks between an empty view's rays.
    const bool slipped_in = !photograph.record.labels.labels.empty() || !photograph.record.labels.left_out.empty();
    if (kind != ViewKind::kEmpty || !slipped_in) return photograph;
    if (tried == kTriesForEmpty) kind = ViewKind::kRoute;
  }
}

Photograph HallPhotographer::State::take(const View& view, int index) {
  const auto X_WC = [&](Stamp stamp) { return view.X_WC(stamp - now); };
  FrameImages images = camera.look(now, X_WC, true, false, config.depth);
  Photograph out;
  out.colour = images.colour;
  out.depth = images.depth;
  out.instances = images.instances;
  char name[32];
  std::snprintf(name, sizeof name, "%06d", index);
  out.record.index = index;
  out.record.name = name;
  out.record.kind = to_text(view.kind);
  out.record.intrinsics = lens.intrinsics();
  out.record.distortion = lens.distortion();
  out.record.X_WC = X_WC(now);
  const std::vector<ObjectView> seen = object_views(*ray_caster, camera.picture_rays(now, X_WC), images.instances);
  out.record.labels = label_objects(seen, images.instances, *hall.scene, classes, config.labels, config.polygon_tolerance_px);
  return out;
}

}  // namespace waretwin
