#include "sensors/recordings/calibration.h"

#include <map>

#include "core/error.h"
#include "sensors/recordings/contents.h"

namespace waretwin {

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
  const bool direction = up.size() == 3 && Eigen::Vector3d(up[0], up[1], up[2]).norm() > 1e-6;
  if (!direction) f.reject("up", "is not a direction; expected three numbers that are not all 0");
}

namespace {

template <class T>
void expect_one(const std::map<std::string, T>& sensors, const std::string& kind) {
  if (sensors.size() <= 1) return;
  std::string names;
  for (const auto& entry : sensors) names += (names.empty() ? "" : ", ") + entry.first;
  throw Error("a recording holds one " + kind + ", the stream has " + std::to_string(sensors.size()) + " (sensors." + kind + "s: " + names +
              "); expected one");
}

}  // namespace

RecordingCalibration calibration_of(const StreamInfo& info) {
  expect_one(info.cameras, "camera");
  expect_one(info.lasers, "laser");
  if (info.cameras.empty() && info.lasers.empty()) {
    throw Error(info.source + ": has neither camera nor laser (sensors.cameras, sensors.lasers); expected one of them");
  }
  RecordingCalibration calibration;
  for (const auto& [name, camera] : info.cameras) {
    const Intrinsics& k = camera.intrinsics;
    calibration.has_camera = true;
    RecordingCalibration::Camera& c = calibration.camera;
    c.name = name;
    c.width = k.width, c.height = k.height;
    c.fx = k.fx, c.fy = k.fy, c.cx = k.cx, c.cy = k.cy;
    c.depth_min_m = camera.depth_min_m, c.depth_max_m = camera.depth_max_m;
    c.depth_scale = 1000.0;
    c.rate_hz = camera.rate_hz;
    c.X_BC = pose_numbers(camera.X_BC);
    if (!camera.native) continue;
    const Intrinsics& own = camera.native->lens.intrinsics();
    c.has_native = true;
    c.native.width = own.width, c.native.height = own.height;
    c.native.fx = own.fx, c.native.fy = own.fy, c.native.cx = own.cx, c.native.cy = own.cy;
    c.native.distortion = camera.native->lens.distortion();
    c.native.X_CD = pose_numbers(camera.native->X_CD);
  }
  for (const auto& [name, laser] : info.lasers) {
    calibration.has_laser = true;
    calibration.laser = {name, laser.rate_hz, pose_numbers(laser.X_BL)};
  }
  calibration.X_WB_start = pose_numbers(info.X_WB_start);
  if (info.own_body_B) {
    const Eigen::Vector3d &low = info.own_body_B->min(), &high = info.own_body_B->max();
    calibration.own_body = {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
  }
  calibration.up = {info.up_W.x(), info.up_W.y(), info.up_W.z()};
  return calibration;
}

}  // namespace waretwin
