#include "harness/calibrate/extrinsics.h"

#include <algorithm>
#include <cmath>

#include "core/config.h"
#include "core/error.h"
#include "core/version.h"
#include "sensors/recordings/recording.h"

namespace waretwin {

void Extrinsics::visit(Fields& f) {
  f("camera", camera, "whose pose on the vehicle it is", {.required = true});
  f("laser", laser, "that it was measured against", {.required = true});
  f("X_BC", X_BC, "camera (z forward, x right, y down) on the vehicle: twelve numbers of the 4 x 4 matrix, row by row",
    {.min = -1e3, .max = 1e3, .length = 12, .required = true});
  f("X_BL", X_BL, "where the laser was taken to sit", {.min = -1e3, .max = 1e3, .length = 12, .required = true});
  const auto figure = [&](const char* key, double& value, const char* doc) { f(key, value, doc); };
  figure("x_m", mount.x_m, "X_BC as the keys of a scenario's mount have it");
  figure("y_m", mount.y_m, "");
  figure("z_m", mount.z_m, "");
  figure("yaw_deg", mount.yaw_deg, "");
  figure("pitch_deg", mount.pitch_deg, "");
  figure("roll_deg", mount.roll_deg, "");
  f("sigma_m", sigma_m, "standard deviation of the camera's place along the vehicle's x, y, z");
  f("sigma_deg", sigma_deg, "standard deviation of its turn about the vehicle's x, y, z");
  f("covariance", covariance, "of shift (m) and turn (rad), 6 x 6, row by row");
  f("range_bias_m", range_bias_m, "the laser's ranges read so much too long");
  f("range_bias_sigma_m", range_bias_sigma_m, "standard deviation of that");
  f("poses", poses, "of the board");
  f("points", points, "beams on it, each the mean of many scans");
  f("beam_rms_m", beam_rms_m, "what is left of them, along the beams");
  f("corner_sigma_px", corner_sigma_px, "of one coordinate of a corner, from what is left of them");
}

Mount mount_of(const Pose& X_BC) {
  const Eigen::Matrix3d R = X_BC.linear() * optical_from_forward().transpose();
  Mount mount;
  mount.x_m = X_BC.translation().x();
  mount.y_m = X_BC.translation().y();
  mount.z_m = X_BC.translation().z();
  mount.yaw_deg = to_degrees(std::atan2(R(1, 0), R(0, 0)));
  mount.pitch_deg = to_degrees(std::asin(std::clamp(-R(2, 0), -1.0, 1.0)));
  mount.roll_deg = to_degrees(std::atan2(R(2, 1), R(2, 2)));
  return mount;
}

Extrinsics extrinsics_of(const Calibration& calibration) {
  const Refined& found = calibration.found;
  Extrinsics e;
  e.camera = calibration.camera;
  e.laser = calibration.laser;
  e.X_BC = pose_numbers(found.X_BC);
  e.X_BL = pose_numbers(calibration.X_BL);
  e.mount = mount_of(found.X_BC);
  for (int i = 0; i < 3; ++i) {
    e.sigma_m.push_back(std::sqrt(found.covariance(i, i)));
    e.sigma_deg.push_back(to_degrees(std::sqrt(found.covariance(i + 3, i + 3))));
  }
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) e.covariance.push_back(found.covariance(r, c));
  }
  e.range_bias_m = found.bias_m;
  e.range_bias_sigma_m = std::sqrt(found.covariance(6, 6));
  e.poses = calibration.used_poses;
  e.points = found.points;
  e.beam_rms_m = found.rms_m;
  e.corner_sigma_px = found.corner_sigma_px;
  return e;
}

std::string extrinsics_yaml(const Extrinsics& extrinsics, const std::string& source) {
  Extrinsics copy = extrinsics;
  return "# waretwin " + std::string(kVersion) + ", calibrate " + source + "\n" + write_config([&](Fields& f) { copy.visit(f); });
}

Extrinsics read_extrinsics(const std::filesystem::path& file) {
  Extrinsics extrinsics;
  read_config_into(file, extrinsics);
  for (const std::vector<double>* pose : {&extrinsics.X_BC, &extrinsics.X_BL}) {
    try {
      pose_from_numbers(*pose);
    } catch (const Error& error) {
      throw Error(file, std::string(pose == &extrinsics.X_BC ? "X_BC: " : "X_BL: ") + error.what());
    }
  }
  return extrinsics;
}

StreamInfo told_by_extrinsics(StreamInfo info, const std::filesystem::path& file) {
  if (file.empty()) return info;
  const Extrinsics extrinsics = read_extrinsics(file);
  const auto camera = info.cameras.find(extrinsics.camera);
  if (camera == info.cameras.end()) {
    std::string names;
    for (const auto& entry : info.cameras) names += (names.empty() ? "" : ", ") + entry.first;
    throw Error(file, "camera: '" + extrinsics.camera + "' is not in " + info.source + "; expected " + (names.empty() ? "none" : names));
  }
  const Pose X_BC = pose_from_numbers(extrinsics.X_BC), X_BL = pose_from_numbers(extrinsics.X_BL);
  const auto laser = info.lasers.find(extrinsics.laser);
  camera->second.X_BC = laser == info.lasers.end() ? X_BC : orthonormalised(laser->second.X_BL * X_BL.inverse() * X_BC);
  return info;
}

}  // namespace waretwin
