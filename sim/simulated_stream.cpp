#include "sim/simulated_stream.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "sensors/laser_noise.h"
#include "sensors/mount_error.h"
#include "sensors/odometry_model.h"
#include "sim/colour_camera.h"
#include "sim/depth_camera.h"
#include "sim/laser_spot.h"
#include "sim/ray_caster.h"
#include "sim/renderer.h"

namespace waretwin {

namespace {

constexpr const char* kOdometryName = "odometry";
// Movers go evenly from this much before a frame's stamp to this much after it: longer than the exposures of depth, and of colour unless
// its readout is configured to be longer.
constexpr Stamp kFrameReach = 25'000'000;

// Sensors measure at whole multiples of their period; one rounding each, so that rates like 15 Hz don't drift.
Stamp stamp_of_turn(std::int64_t turn, double rate_hz) { return from_seconds(static_cast<double>(turn) / rate_hz); }

// Measurements from stamp 0 to `end`, both included.
std::int64_t turns_until(Stamp end, double rate_hz) {
  if (end < 0) return 0;
  auto turns = static_cast<std::int64_t>(std::floor(to_seconds(end) * rate_hz));
  while (stamp_of_turn(turns + 1, rate_hz) <= end) ++turns;
  while (stamp_of_turn(turns, rate_hz) > end) --turns;
  return turns + 1;
}

enum class SensorKind { kOdometry, kLaser, kCamera };  // also the order of equal stamps

struct Source {
  SensorKind kind;
  std::string name;
  double rate_hz;
  std::int64_t turns;     // in the whole drive
  std::int64_t next = 0;  // turn to come

  Stamp stamp() const { return stamp_of_turn(next, rate_hz); }
};

std::vector<Stamp> camera_stamps(const std::vector<Source>& sources) {
  std::vector<Stamp> stamps;
  for (const Source& source : sources) {
    if (source.kind != SensorKind::kCamera) continue;
    for (std::int64_t turn = 0; turn < source.turns; ++turn) stamps.push_back(stamp_of_turn(turn, source.rate_hz));
  }
  std::sort(stamps.begin(), stamps.end());
  return stamps;
}

// The box of the vehicle's model, a little wider than it, since depth and ranges err. An open frame's box holds more than the vehicle: what
// it carries, or what it stands around, is masked, too.
std::optional<Eigen::AlignedBox3d> own_body(const Scene& scene) {
  if (scene.vehicle.empty()) return std::nullopt;
  constexpr double kMargin = 0.03;
  Eigen::AlignedBox3d box;
  for (const int index : scene.vehicle) {
    const Instance& instance = scene.instances[static_cast<std::size_t>(index)];
    for (const Eigen::Vector3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions)
      box.extend((instance.X_WM * p).cast<double>());
  }
  return Eigen::AlignedBox3d(box.min() - Eigen::Vector3d::Constant(kMargin), box.max() + Eigen::Vector3d::Constant(kMargin));
}

}  // namespace

void SimulationConfig::visit(Fields& f) {
  f.group("render", render, "how colour pictures are made");
  f("colour", colour, "false: black colour pictures, for runs that use depth alone");
  f("truth_depth", truth_depth, "depth without error, field mask and range limits");
  f("max_frames", max_frames, "ends the drive after this many camera frames; 0 = the whole route", {.min = 0});
  RayCasterOptions caster;
  caster.isa = isa;
  caster.visit(f);
  isa = caster.isa;
}

struct SimulatedStream::State {
  State(const Scenario& a_scenario, std::shared_ptr<const Scene> a_scene, const SimulationConfig& a_config);

  Scenario scenario;
  SimulationConfig config;
  std::shared_ptr<RayCaster> ray_caster;
  HallMotion motion;
  Renderer renderer;
  std::map<std::string, ColourCamera> colour_cameras;
  std::map<std::string, std::unique_ptr<DepthCamera>> depth_cameras;
  std::map<std::string, LaserNoiseModel> laser_noise;
  std::map<std::string, MountError> mounts;  // of cameras and lasers
  OdometryModel odometry;
  StreamInfo info;
  std::vector<Source> sources;
  FrameTruth truth;
  HallMoment truth_moment;  // of `truth`, once its images are there
  int frames_sent = 0, frames_rendered = 0;
  double last_frame_ms = 0.0;

  void describe();
  // How fast the vehicle rolls, over the last hundredth of a second; 0 for a mount that does not shake.
  double speed(const MountError& mount, Stamp stamp) const;
  Pose X_WC(const std::string& camera, Stamp stamp) const;
  Pose X_WL(const std::string& laser, Stamp stamp) const;
  LaserScan scan(const std::string& name, Stamp stamp);
  void render(RgbdFrame& frame, const HallMoment& moment);
};

SimulatedStream::State::State(const Scenario& a_scenario, std::shared_ptr<const Scene> a_scene, const SimulationConfig& a_config)
    : scenario(a_scenario),
      config(a_config),
      ray_caster(std::make_shared<RayCaster>(std::move(a_scene), RayCasterOptions{.isa = a_config.isa})),
      motion(a_scenario, *ray_caster),
      renderer(ray_caster,
               [&] {
                 RenderOptions options = a_config.render;
                 options.exposure *= a_scenario.lighting.exposure;
                 return options;
               }()),
      odometry(a_scenario.sensors.odometry, a_scenario.seed, kOdometryName) {
  const SensorsConfig& sensors = scenario.sensors;
  const Stamp end = motion.duration();
  if (sensors.odometry.enabled) {
    sources.push_back({SensorKind::kOdometry, kOdometryName, sensors.odometry.rate_hz, turns_until(end, sensors.odometry.rate_hz)});
  }
  for (const auto& [name, laser] : sensors.lasers) {
    const Stamp turn = static_cast<Stamp>(laser.beams - 1) * laser.beam_interval();
    sources.push_back({SensorKind::kLaser, name, laser.rate_hz, turns_until(end - turn, laser.rate_hz)});
    laser_noise.emplace(name, LaserNoiseModel(laser, scenario.seed, name));
    mounts.emplace(name, MountError(laser.mount, scenario.seed, name));
  }
  for (const auto& [name, camera] : sensors.cameras) {
    sources.push_back({SensorKind::kCamera, name, camera.rate_hz, turns_until(end, camera.rate_hz)});
    mounts.emplace(name, MountError(camera.mount, scenario.seed, name));
    colour_cameras.emplace(name, ColourCamera(camera, scenario.seed, name, renderer));
    depth_cameras.emplace(name, DepthCamera::make(camera, scenario.seed, name, ray_caster, renderer.surfaces()));
  }
  describe();
}

void SimulatedStream::State::describe() {
  info.source = scenario.name;
  for (const auto& [name, camera] : scenario.sensors.cameras) {
    info.cameras[name] = {camera.view().intrinsics(), camera.mount.X_BC(), camera.depth_min_m, camera.depth_max_m, camera.rate_hz};
    // True depth comes in the colour view alone.
    if (camera.depth_model != "gaussian" && !config.truth_depth) {
      info.cameras[name].native = DepthCameraView{camera.depth_lens(), camera.X_CD()};
    }
  }
  for (const auto& [name, laser] : scenario.sensors.lasers) info.lasers[name] = {laser.mount.X_BL(), laser.rate_hz};
  info.own_body_B = own_body(ray_caster->scene());
  info.has_odometry = scenario.sensors.odometry.enabled;
  info.X_WB_start = motion.X_WB(0);
  const std::vector<Stamp> frames = camera_stamps(sources);
  info.frame_count = static_cast<int>(frames.size());
  info.duration_s = to_seconds(motion.duration());
  if (config.max_frames > 0 && config.max_frames <= static_cast<int>(frames.size())) {
    info.frame_count = config.max_frames;
    info.duration_s = to_seconds(frames[static_cast<std::size_t>(config.max_frames) - 1]);
  }
}

double SimulatedStream::State::speed(const MountError& mount, Stamp stamp) const {
  if (!mount.shakes() || stamp <= 0) return 0.0;
  constexpr Stamp kStep = 10'000'000;
  const Stamp before = std::max<Stamp>(0, stamp - kStep);
  const Pose X_AB = motion.X_WB(before).inverse() * motion.X_WB(stamp);
  // A vehicle that turns in place rolls, too: its wheels are about this far from the middle.
  const double wheels = 0.4 * scenario.robot.width_m, turned = Eigen::AngleAxisd(X_AB.linear()).angle();
  return (X_AB.translation().norm() + wheels * std::abs(turned)) / to_seconds(stamp - before);
}

Pose SimulatedStream::State::X_WC(const std::string& camera, Stamp stamp) const {
  const MountError& mount = mounts.at(camera);
  return motion.X_WB(stamp) * mount.X_BC(stamp, speed(mount, stamp));
}

Pose SimulatedStream::State::X_WL(const std::string& laser, Stamp stamp) const {
  const MountError& mount = mounts.at(laser);
  return motion.X_WB(stamp) * mount.X_BL(stamp, speed(mount, stamp));
}

LaserScan SimulatedStream::State::scan(const std::string& name, Stamp stamp) {
  const LaserConfig& laser = scenario.sensors.lasers.at(name);
  const Stamp end = stamp + static_cast<Stamp>(laser.beams - 1) * laser.beam_interval();
  motion.advance_to(end);
  motion.moment(stamp, end).show(*ray_caster);
  LaserScan scan = spot_scan(*ray_caster, renderer.surfaces(), laser, name, stamp, [&](Stamp at) { return X_WL(name, at); });
  laser_noise.at(name).apply(scan);
  return scan;
}

void SimulatedStream::State::render(RgbdFrame& frame, const HallMoment& moment) {
  const auto begin = std::chrono::steady_clock::now();
  moment.show(*ray_caster);
  const auto at = [&](Stamp stamp) { return X_WC(frame.sensor, stamp); };
  const bool ideal = config.ideal_depth || config.truth_depth || scenario.sensors.cameras.at(frame.sensor).depth_model == "gaussian";
  FrameImages images = colour_cameras.at(frame.sensor).look(frame.stamp, at, config.colour, false, ideal);
  frame.colour = config.colour ? images.colour : cv::Mat(images.instances.size(), CV_8UC3, cv::Scalar::all(0));
  if (config.truth_depth) {
    frame.depth = depth_from_millimetres(depth_to_millimetres(images.depth));
  } else {
    DepthReading reading = depth_cameras.at(frame.sensor)->read(images.depth, frame.stamp, at);
    frame.depth = reading.registered;
    frame.native_depth = reading.native;
  }
  if (truth.stamp == frame.stamp && truth.sensor == frame.sensor) {
    truth.instances = images.instances;
    truth.ideal_depth = images.depth;
    truth_moment = moment;
  }
  ++frames_rendered;
  last_frame_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

SimulatedStream::SimulatedStream(const Scenario& scenario, std::shared_ptr<const Scene> scene, const SimulationConfig& config)
    : state_(std::make_shared<State>(scenario, std::move(scene), config)) {}

SimulatedStream::~SimulatedStream() = default;

const StreamInfo& SimulatedStream::info() const { return state_->info; }

std::optional<SensorEvent> SimulatedStream::next() {
  State& s = *state_;
  if (s.config.max_frames > 0 && s.frames_sent >= s.config.max_frames) return std::nullopt;
  Source* first = nullptr;
  for (Source& source : s.sources) {
    if (source.next >= source.turns) continue;
    const auto key = [](const Source& a) { return std::tuple(a.stamp(), static_cast<int>(a.kind), std::string_view(a.name)); };
    if (first == nullptr || key(source) < key(*first)) first = &source;
  }
  if (first == nullptr) return std::nullopt;
  const Stamp stamp = first->stamp();
  ++first->next;
  if (first->kind == SensorKind::kOdometry) {
    s.motion.advance_to(stamp);
    return s.odometry.advance(stamp, s.motion.wheels_X_WB(stamp));
  }
  if (first->kind == SensorKind::kLaser) return s.scan(first->name, stamp);
  ++s.frames_sent;
  const TimeOfFlightConfig& depth = s.scenario.sensors.cameras.at(first->name).time_of_flight;
  const Stamp reach =
      std::max({kFrameReach, s.colour_cameras.at(first->name).half_span(), from_seconds(depth.motion ? 0.5 * depth.exposure_s : 0.0)});
  s.motion.advance_to(stamp + reach);
  s.truth = {};
  s.truth.stamp = stamp;
  s.truth.sensor = first->name;
  s.truth.X_WB = s.motion.X_WB(stamp);
  s.truth.X_WC = s.X_WC(first->name, stamp);
  RgbdFrame frame;
  frame.stamp = stamp;
  frame.sensor = first->name;
  frame.load = [state = state_, moment = s.motion.moment(stamp - reach, stamp + reach)](RgbdFrame& to_load) {
    state->render(to_load, moment);
  };
  return frame;
}

Pose SimulatedStream::true_X_WB(Stamp stamp) const { return state_->motion.X_WB(stamp); }
Pose SimulatedStream::true_X_WC(const std::string& camera, Stamp stamp) const {
  if (state_->scenario.sensors.cameras.count(camera) == 0) throw Error("no camera '" + camera + "'");
  return state_->X_WC(camera, stamp);
}
Pose SimulatedStream::true_X_WL(const std::string& laser, Stamp stamp) const {
  if (state_->scenario.sensors.lasers.count(laser) == 0) throw Error("no laser '" + laser + "'");
  return state_->X_WL(laser, stamp);
}
MotionReport SimulatedStream::motion() const { return state_->motion.report(); }
const FrameTruth& SimulatedStream::last_frame_truth() const { return state_->truth; }
std::vector<ObjectView> SimulatedStream::object_views() {
  State& s = *state_;
  if (s.truth.instances.empty()) return {};
  s.truth_moment.show(*s.ray_caster);
  const auto at = [&s](Stamp stamp) { return s.X_WC(s.truth.sensor, stamp); };
  return waretwin::object_views(*s.ray_caster, s.colour_cameras.at(s.truth.sensor).picture_rays(s.truth.stamp, at), s.truth.instances);
}

const Scene& SimulatedStream::scene() const { return state_->ray_caster->scene(); }
std::shared_ptr<const RayCaster> SimulatedStream::ray_caster() const { return state_->ray_caster; }
int SimulatedStream::frames_rendered() const { return state_->frames_rendered; }
double SimulatedStream::last_frame_ms() const { return state_->last_frame_ms; }
double SimulatedStream::duration_s() const { return to_seconds(state_->motion.duration()); }
double SimulatedStream::distance_driven_m() const { return state_->motion.distance_m(); }

}  // namespace waretwin
