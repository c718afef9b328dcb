#include "sensors/recordings/recording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/config.h"
#include "core/error.h"
#include "sensors/recordings/carmen_log.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/recorded_image.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

Eigen::Vector3d up_from(const std::vector<double>& numbers) { return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]).normalized(); }

bool has_direction(const std::vector<double>& numbers) {
  return numbers.size() == 3 && Eigen::Vector3d(numbers[0], numbers[1], numbers[2]).norm() > 1e-6;
}

void check_size(const cv::Mat& image, const fs::path& file, const Intrinsics& intrinsics) {
  if (image.cols == intrinsics.width && image.rows == intrinsics.height) return;
  throw Error(file, "has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " pixels; expected " +
                        std::to_string(intrinsics.width) + " x " + std::to_string(intrinsics.height));
}

std::function<void(RgbdFrame&)> loader(const RecordedFrame& recorded, const StreamInfo::Camera& camera, double depth_scale) {
  std::optional<Intrinsics> native;
  if (camera.native) native = camera.native->lens.intrinsics();
  return [recorded, intrinsics = camera.intrinsics, native, depth_scale](RgbdFrame& frame) {
    cv::Mat colour = read_colour_image(recorded.colour);
    check_size(colour, recorded.colour, intrinsics);
    cv::Mat depth = read_depth_image(recorded.depth, depth_scale);
    check_size(depth, recorded.depth, intrinsics);
    cv::Mat native_depth;
    if (native && !recorded.native_depth.empty()) {
      native_depth = read_depth_image(recorded.native_depth, depth_scale);
      check_size(native_depth, recorded.native_depth, *native);
    }
    frame.colour = std::move(colour);
    frame.depth = std::move(depth);
    frame.native_depth = std::move(native_depth);
  };
}

class FolderRecording final : public Recording {
 public:
  FolderRecording(StreamInfo info, std::vector<SensorEvent> events, int lost_frames)
      : info_(std::move(info)), events_(std::move(events)), lost_frames_(lost_frames) {}

  const StreamInfo& info() const override { return info_; }
  int lost_frames() const override { return lost_frames_; }
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
};

// The camera and its frames, into `info` and `events`.
void add_frames(const RecordingContents& contents, const RecordingConfig& config, const std::optional<RecordingCalibration>& calibration,
                StreamInfo& info, std::vector<SensorEvent>& events) {
  const RecordingCalibration::Camera* known = calibration && calibration->has_camera ? &calibration->camera : nullptr;
  double depth_scale = config.depth_scale > 0.0 ? config.depth_scale : known ? known->depth_scale : contents.depth_scale;
  StreamInfo::Camera camera;
  if (known && config.intrinsics.empty()) {
    camera.intrinsics = Intrinsics::checked(known->width, known->height, known->fx, known->fy, known->cx, known->cy);
  } else {
    // The layouts' own calibrations do not name the size of the pictures.
    const RecordedFrame& first = contents.frames.front();
    const cv::Mat colour = read_colour_image(first.colour);
    const std::vector<double>& k = config.intrinsics.empty() ? contents.intrinsics : config.intrinsics;
    camera.intrinsics = Intrinsics::checked(colour.cols, colour.rows, k[0], k[1], k[2], k[3]);
  }
  camera.X_BC = known ? pose_from_numbers(known->X_BC) : Pose::Identity();
  camera.depth_min_m = known ? known->depth_min_m : config.depth_min_m;
  camera.depth_max_m = known ? known->depth_max_m : config.depth_max_m;
  camera.rate_hz = known ? known->rate_hz : contents.rate_hz;
  const auto is_native = [](const RecordedFrame& f) { return !f.native_depth.empty(); };
  if (known && known->has_native) {
    const RecordingCalibration::Native& n = known->native;
    camera.native =
        DepthCameraView{Lens(Intrinsics::checked(n.width, n.height, n.fx, n.fy, n.cx, n.cy), n.distortion), pose_from_numbers(n.X_CD)};
  } else if (std::any_of(contents.frames.begin(), contents.frames.end(), is_native)) {
    throw Error(info.source + ": has depth_native.txt, but no lens for it; expected has_native and native under camera in recording.yaml");
  }
  const std::string name = known ? known->name : "camera";
  for (const RecordedFrame& recorded : contents.frames) {
    RgbdFrame frame;
    frame.stamp = recorded.stamp;
    frame.sensor = name;
    frame.recorded_X_WC = recorded.X_WC;
    frame.load = loader(recorded, camera, depth_scale);
    info.has_recorded_poses = info.has_recorded_poses || recorded.X_WC.has_value();
    events.emplace_back(std::move(frame));
  }
  info.cameras[name] = camera;
  info.frame_count = static_cast<int>(contents.frames.size());
  info.up_W = contents.up_W;
  const auto first_pose = std::find_if(contents.frames.begin(), contents.frames.end(), [](const auto& f) { return f.X_WC.has_value(); });
  if (first_pose != contents.frames.end()) info.X_WB_start = *first_pose->X_WC * camera.X_BC.inverse();
}

}  // namespace

std::optional<Pose> rigid_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  constexpr double kTolerance = 0.01;
  const Eigen::Matrix3d excess = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  if (!rotation.allFinite() || !translation.allFinite() || excess.cwiseAbs().maxCoeff() > kTolerance || rotation.determinant() < 0) {
    return std::nullopt;
  }
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  // What is orthonormal to the last bits stays as it is: our own recordings give back the very pose that was written.
  return excess.cwiseAbs().maxCoeff() < 1e-12 ? pose : orthonormalised(pose);
}

std::vector<double> pose_numbers(const Pose& pose) {
  std::vector<double> numbers;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
  }
  return numbers;
}

Pose pose_from_numbers(const std::vector<double>& numbers) {
  if (numbers.size() != 12) throw Error("a pose has " + std::to_string(numbers.size()) + " numbers; expected 12");
  Eigen::Matrix<double, 3, 4> m;
  for (int i = 0; i < 12; ++i) m(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)];
  const std::optional<Pose> pose = rigid_pose(m.leftCols<3>(), m.col(3));
  if (!pose) throw Error("a pose is not a rigid motion; expected the upper three rows of its matrix");
  return *pose;
}

void RecordingConfig::visit(Fields& f) {
  f("up", up, "direction that points up in the recording's world; empty = as the layout says");
  if (!up.empty() && !has_direction(up)) f.reject("up", "is not a direction; expected three numbers that are not all 0, or none");
  f("intrinsics", intrinsics, "fx, fy, cx, cy in pixels; empty = the recording's own");
  if (!intrinsics.empty() && intrinsics.size() != 4) f.reject("intrinsics", "has not four numbers; expected fx, fy, cx, cy, or none");
  f("depth_min_m", depth_min_m, "nearer depth is not trusted", {.min = 0, .max = 100});
  f("depth_max_m", depth_max_m, "farther depth is not trusted", {.min = 0, .max = 100});
  if (depth_max_m <= depth_min_m) f.reject("depth_max_m", "must be greater than depth_min_m");
  f("depth_scale", depth_scale, "units of a depth image in one metre; 0 = as the layout says", {.min = 0, .max = 1e6});
  f("frame_rate_hz", frame_rate_hz, "frames a second, where frames are numbered", {.min = 0.001, .max = 10000});
  f("association_s", association_s, "most time between a picture and its depth image", {.min = 0, .max = 10});
}

namespace {

void visit_pose(Fields& f, const char* key, std::vector<double>& numbers, const char* doc) {
  f(key, numbers, doc, {.length = 12});
  try {
    pose_from_numbers(numbers);
  } catch (const Error& error) {
    f.reject(key, "does not hold: " + std::string(error.what()));
  }
}

// Of a Camera or a Native.
template <class Pinhole>
void visit_intrinsics(Fields& f, Pinhole& camera) {
  f("width", camera.width, "pixels", {.min = 1, .max = 16384, .required = true});
  f("height", camera.height, "pixels", {.min = 1, .max = 16384, .required = true});
  f("fx", camera.fx, "focal length in pixels", {.min = 1e-3, .max = 1e6, .required = true});
  f("fy", camera.fy, "focal length in pixels", {.min = 1e-3, .max = 1e6, .required = true});
  f("cx", camera.cx, "principal point in pixels", {.required = true});
  f("cy", camera.cy, "principal point in pixels", {.required = true});
}

}  // namespace

void RecordingCalibration::Native::visit(Fields& f) {
  visit_intrinsics(f, *this);
  f.group("distortion", distortion, "of the lens");
  visit_pose(f, "X_CD", X_CD, "pose of the depth camera in the colour camera's frame, 3 x 4, row by row");
}

void RecordingCalibration::Camera::visit(Fields& f) {
  f("name", name, "the sensor's name");
  visit_intrinsics(f, *this);
  f("depth_min_m", depth_min_m, "nearer depth is not trusted", {.min = 0, .max = 100});
  f("depth_max_m", depth_max_m, "farther depth is not trusted", {.min = 0, .max = 100});
  f("depth_scale", depth_scale, "units of a depth image in one metre", {.min = 1e-3, .max = 1e6});
  f("rate_hz", rate_hz, "nominal frames a second", {.min = 0.001, .max = 10000});
  visit_pose(f, "X_BC", X_BC, "pose of the camera on the vehicle, 3 x 4, row by row");
  f("has_native", has_native, "whether `native` counts");
  if (has_native) f.group("native", native, "the depth camera's own view, that of depth_native.txt", {.required = true});
}

void RecordingCalibration::Laser::visit(Fields& f) {
  f("name", name, "the sensor's name");
  f("rate_hz", rate_hz, "nominal scans a second", {.min = 0.001, .max = 10000});
  visit_pose(f, "X_BL", X_BL, "pose of the laser on the vehicle, 3 x 4, row by row");
}

void RecordingCalibration::visit(Fields& f) {
  f("has_camera", has_camera, "whether `camera` counts");
  f("has_laser", has_laser, "whether `laser` counts");
  if (has_camera) f.group("camera", camera, "the camera", {.required = true});
  if (has_laser) f.group("laser", laser, "the laser", {.required = true});
  visit_pose(f, "X_WB_start", X_WB_start, "pose of the vehicle at the first event, 3 x 4, row by row");
  f("up", up, "direction that points up in the recording's world", {.length = 3});
  f("own_body", own_body, "box of the vehicle's own body in its frame: least x, y, z, most x, y, z; empty: its sensors see nothing of it");
  const bool box = own_body.size() == 6 && own_body[0] < own_body[3] && own_body[1] < own_body[4] && own_body[2] < own_body[5];
  if (!own_body.empty() && !box) f.reject("own_body", "is no box; expected nothing, or least x, y, z and then most x, y, z");
  if (!has_direction(up)) f.reject("up", "is not a direction; expected three numbers that are not all 0");
}

bool is_carmen_log(const fs::path& file) {
  if (!fs::is_regular_file(file)) return false;
  const fs::path name = file.extension() == ".gz" ? file.stem() : file;
  return name.extension() == ".log" || name.extension() == ".clf";
}

std::unique_ptr<Recording> open_recording(const fs::path& folder, const RecordingConfig& config) {
  if (!fs::exists(folder)) throw Error(folder, "no such folder or log");
  if (is_carmen_log(folder)) {
    CarmenLog log = read_carmen_log(folder);
    return std::make_unique<FolderRecording>(std::move(log.info), std::move(log.events), 0);
  }
  if (!fs::is_directory(folder)) throw Error(folder, "is not a folder; expected a recording's folder, or a CARMEN log (.log, .log.gz)");
  const fs::path laser_file = folder / "laser.txt";
  const fs::path odometry_file = folder / "odometry.txt";
  const fs::path calibration_file = folder / "recording.yaml";

  std::optional<RecordingContents> contents;
  if (is_tum_folder(folder)) {
    contents = read_tum_folder(folder, config);
  } else if (is_frame_folder(folder)) {
    contents = read_frame_folder(folder, config);
  } else if (!fs::exists(laser_file)) {
    throw Error(folder,
                "is no recording; expected rgb.txt and depth.txt (TUM), frame-NNNNNN.color.png with camera-intrinsics.txt (7-Scenes), or "
                "laser.txt");
  }
  std::optional<RecordingCalibration> calibration;
  if (fs::exists(calibration_file)) {
    calibration.emplace();
    read_config_into(calibration_file, *calibration);
  }

  StreamInfo info;
  info.source = fs::absolute(folder).lexically_normal().filename().string();
  if (info.source.empty()) info.source = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  std::vector<SensorEvent> events;
  // Sorted by stamp below; among equal stamps odometry comes before the laser and the laser before the camera, as in the simulation.
  if (fs::exists(odometry_file)) {
    for (OdometryReading& reading : read_odometry_file(odometry_file, "odometry")) events.emplace_back(std::move(reading));
    info.has_odometry = true;
  }
  if (fs::exists(laser_file)) {
    const RecordingCalibration::Laser laser = calibration && calibration->has_laser ? calibration->laser : RecordingCalibration::Laser{};
    for (LaserScan& scan : read_laser_file(laser_file, laser.name)) events.emplace_back(std::move(scan));
    info.lasers[laser.name] = {pose_from_numbers(laser.X_BL), laser.rate_hz};
  }
  if (contents) add_frames(*contents, config, calibration, info, events);
  if (calibration) {
    info.X_WB_start = pose_from_numbers(calibration->X_WB_start);
    const std::vector<double>& box = calibration->own_body;
    if (!box.empty()) info.own_body_B.emplace(Eigen::Vector3d(box[0], box[1], box[2]), Eigen::Vector3d(box[3], box[4], box[5]));
    info.up_W = up_from(calibration->up);
  }
  if (!config.up.empty()) {
    if (!has_direction(config.up)) throw Error("up: expected three numbers that are not all 0");
    info.up_W = up_from(config.up);
  }
  std::stable_sort(events.begin(), events.end(), [](const SensorEvent& a, const SensorEvent& b) { return stamp_of(a) < stamp_of(b); });
  if (!events.empty()) info.duration_s = to_seconds(stamp_of(events.back()) - stamp_of(events.front()));
  return std::make_unique<FolderRecording>(std::move(info), std::move(events), contents ? contents->lost_frames : 0);
}

}  // namespace waretwin
