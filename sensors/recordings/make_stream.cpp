// What a recording holds, calibrated and in order, as a stream.
#include <algorithm>
#include <utility>

#include "core/error.h"
#include "sensors/mount.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/picture_loader.h"

namespace waretwin {

namespace {

class RecordedStream final : public Recording {
 public:
  RecordedStream(StreamInfo info, std::vector<SensorEvent> events, const RecordingContents& contents)
      : info_(std::move(info)),
        events_(std::move(events)),
        lost_frames_(contents.lost_frames),
        remarks_(contents.remarks),
        sources_(contents.sources) {}

  const StreamInfo& info() const override { return info_; }
  int lost_frames() const override { return lost_frames_; }
  const std::vector<std::string>& remarks() const override { return remarks_; }
  const std::vector<std::string>& sources() const override { return sources_; }
  std::optional<SensorEvent> next() override {
    if (next_ == events_.size()) return std::nullopt;
    // Each event is handed out once.
    return std::move(events_[next_++]);
  }

 private:
  StreamInfo info_;
  std::vector<SensorEvent> events_;
  std::size_t next_ = 0;
  int lost_frames_ = 0;
  std::vector<std::string> remarks_, sources_;
};

Eigen::Vector3d direction(const std::vector<double>& n) { return Eigen::Vector3d(n[0], n[1], n[2]).normalized(); }

Mount mount_of(const std::vector<double>& n) {
  return {.x_m = n[0], .y_m = n[1], .z_m = n[2], .yaw_deg = n[3], .pitch_deg = n[4], .roll_deg = n[5]};
}

// The camera of the upright pictures, and what makes them of the stored ones.
struct CameraSetup {
  std::string name = "camera";
  StreamInfo::Camera camera;
  std::shared_ptr<const PictureLoader> loader;
  Pose X_CT = Pose::Identity();  // of the upright pictures' camera in the stored ones'
};

CameraSetup camera_setup(const RecordingContents& contents, const RecordingConfig& config, const RecordingCalibration::Camera* known,
                         const std::string& source) {
  CameraSetup setup;
  // The layouts' own calibrations do not name the size of the pictures.
  int width = 0, height = 0;
  if (known) {
    width = known->width, height = known->height;
  } else {
    const cv::Mat first = contents.frames.front().colour.read();
    width = first.cols, height = first.rows;
  }
  const auto pinhole = [&](const std::vector<double>& k) { return Intrinsics::checked(width, height, k[0], k[1], k[2], k[3]); };
  Intrinsics view = known ? pinhole({known->fx, known->fy, known->cx, known->cy}) : Intrinsics();
  if (!config.intrinsics.empty()) {
    view = pinhole(config.intrinsics);
  } else if (!known) {
    view = pinhole(contents.intrinsics);
  }
  // A picture without distortion has the very pixels of the view.
  const Lens stored = contents.distortion.is_none()
                          ? Lens(view)
                          : Lens(config.intrinsics.empty() ? pinhole(contents.intrinsics) : view, contents.distortion);

  const int turns = config.rotate_deg / 90;
  const TurnedCamera turned = turned_camera(view, turns);
  setup.X_CT = turned.X_CT;
  StreamInfo::Camera& camera = setup.camera;
  camera.intrinsics = turned.intrinsics;
  if (known) setup.name = known->name;
  Pose X_BC = known ? pose_from_numbers(known->X_BC) : contents.X_BC.value_or(Pose::Identity());
  if (turns != 0) X_BC = X_BC * turned.X_CT;
  camera.X_BC = config.camera_mount.empty() ? X_BC : mount_of(config.camera_mount).X_BC();
  const RecordingCalibration::Camera usual;
  camera.depth_min_m = config.depth_min_m > 0.0 ? config.depth_min_m : (known ? *known : usual).depth_min_m;
  camera.depth_max_m = config.depth_max_m > 0.0 ? config.depth_max_m : (known ? *known : usual).depth_max_m;
  if (camera.depth_max_m <= camera.depth_min_m) {
    throw Error(source + ": depth is trusted from " + std::to_string(camera.depth_min_m) + " to " + std::to_string(camera.depth_max_m) +
                " m; expected depth_max_m above depth_min_m");
  }
  camera.rate_hz = known ? known->rate_hz : contents.rate_hz;

  if (known && known->has_native) {
    const RecordingCalibration::Native& n = known->native;
    camera.native =
        DepthCameraView{Lens(Intrinsics::checked(n.width, n.height, n.fx, n.fy, n.cx, n.cy), n.distortion), pose_from_numbers(n.X_CD)};
  } else if (contents.native) {
    camera.native = contents.native;
  } else if (!contents.native_list.empty()) {
    throw Error(source + ": has " + contents.native_list +
                ", but no lens for it; expected has_native and native under camera in recording.yaml");
  }
  if (camera.native && turns != 0) camera.native->X_CD = turned.X_CT.inverse() * camera.native->X_CD;
  DepthUnits units{contents.depth_scale, config.depth_invalid};
  if (known) units.per_metre = known->depth_scale;
  if (config.depth_scale > 0.0) units.per_metre = config.depth_scale;
  std::optional<Intrinsics> native;
  if (camera.native) native = camera.native->lens.intrinsics();
  setup.loader = std::make_shared<const PictureLoader>(PictureLoader::Plan{stored, view, turns, units, native});
  return setup;
}

// The camera and its frames, into `info` and `events`.
void add_frames(const RecordingContents& contents, const RecordingConfig& config, const RecordingCalibration::Camera* known,
                StreamInfo& info, std::vector<SensorEvent>& events) {
  const CameraSetup setup = camera_setup(contents, config, known, info.source);
  const bool turned = config.rotate_deg != 0;
  for (const RecordedFrame& recorded : contents.frames) {
    RgbdFrame frame;
    frame.stamp = recorded.stamp;
    frame.sensor = setup.name;
    frame.recorded_X_WC = recorded.X_WC;
    if (recorded.X_WC && turned) frame.recorded_X_WC = *recorded.X_WC * setup.X_CT;
    frame.load = [recorded, loader = setup.loader](RgbdFrame& f) { loader->load(recorded, f); };
    if (frame.recorded_X_WC && !info.has_recorded_poses) {
      info.has_recorded_poses = true;
      info.X_WB_start = *frame.recorded_X_WC * setup.camera.X_BC.inverse();
    }
    events.emplace_back(std::move(frame));
  }
  info.cameras[setup.name] = setup.camera;
  info.frame_count = static_cast<int>(contents.frames.size());
}

void shift(std::vector<SensorEvent>& events, const ClockOffsets& clock) {
  const Stamp colour = from_seconds(clock.colour_s), laser = from_seconds(clock.laser_s), odometry = from_seconds(clock.odometry_s);
  for (SensorEvent& event : events) {
    if (auto* frame = std::get_if<RgbdFrame>(&event)) {
      if (colour != 0) frame->named_stamp = frame->stamp;
      frame->stamp += colour;
    }
    if (auto* scan = std::get_if<LaserScan>(&event)) scan->stamp += laser;
    if (auto* reading = std::get_if<OdometryReading>(&event)) reading->stamp += odometry;
  }
}

}  // namespace

std::unique_ptr<Recording> make_stream(RecordingContents contents, const std::optional<RecordingCalibration>& calibration,
                                       const RecordingConfig& config, const std::string& source) {
  StreamInfo info;
  info.source = source;
  std::vector<SensorEvent> events;
  // Sorted by stamp below; among equal stamps odometry comes before the laser and the laser before the camera, as in the simulation.
  for (OdometryReading& reading : contents.readings) events.emplace_back(std::move(reading));
  info.has_odometry = contents.has_odometry;
  if (contents.has_laser) {
    const RecordingCalibration::Laser* known = calibration && calibration->has_laser ? &calibration->laser : nullptr;
    const std::string name = known ? known->name : "laser";
    for (LaserScan& scan : contents.scans) {
      scan.sensor = name;
      events.emplace_back(std::move(scan));
    }
    Pose X_BL = known ? pose_from_numbers(known->X_BL) : contents.X_BL.value_or(Pose::Identity());
    if (!config.laser_mount.empty()) X_BL = mount_of(config.laser_mount).X_BL();
    info.lasers[name] = {X_BL, known ? known->rate_hz : contents.laser_rate_hz};
  }
  info.up_W = contents.up_W;
  if (!contents.frames.empty()) {
    add_frames(contents, config, calibration && calibration->has_camera ? &calibration->camera : nullptr, info, events);
  }
  if (calibration) {
    info.X_WB_start = pose_from_numbers(calibration->X_WB_start);
    const std::vector<double>& box = calibration->own_body;
    if (!box.empty()) info.own_body_B.emplace(Eigen::Vector3d(box[0], box[1], box[2]), Eigen::Vector3d(box[3], box[4], box[5]));
    info.up_W = direction(calibration->up);
  }
  if (!config.up.empty()) info.up_W = direction(config.up);
  if (!config.start.empty()) info.X_WB_start = make_upright_pose(config.start[0], config.start[1], 0.0, to_radians(config.start[2]));
  shift(events, config.clock);
  std::stable_sort(events.begin(), events.end(), [](const SensorEvent& a, const SensorEvent& b) { return stamp_of(a) < stamp_of(b); });
  if (!events.empty()) info.duration_s = to_seconds(stamp_of(events.back()) - stamp_of(events.front()));
  return std::make_unique<RecordedStream>(std::move(info), std::move(events), contents);
}

}  // namespace waretwin
