#include "harness/calibrate/calibration_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/add_line.h"
#include "core/version.h"
#include "harness/calibrate/extrinsics.h"
#include "sensors/laser_noise.h"
#include "sensors/mount_error.h"
#include "sensors/recordings/recording.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Eigen::VectorXd& v) { return std::vector<double>(v.data(), v.data() + v.size()); }

CalibrationError error_of(const Calibration& calibration, const Pose& X_BC, const CalibrationTruth& truth) {
  return waretwin::error_of(X_BC, truth.X_BC, calibration.found.covariance.topLeftCorner<6, 6>());
}

Json error_json(const CalibrationError& error) {
  return {{"e_trans_m", error.shift_B.norm()},
          {"e_rot_deg", to_degrees(error.turn_B.norm())},
          {"shift_m", numbers(error.shift_B)},
          {"turn_deg", numbers(error.turn_B * to_degrees(1.0))}};
}

constexpr const char* kLensNames[] = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"};

}  // namespace

CalibrationTruth true_calibration(const Scenario& scenario, const std::string& camera, const std::string& laser) {
  const Mount& camera_mount = scenario.sensors.cameras.at(camera).mount;
  const LaserConfig& laser_config = scenario.sensors.lasers.at(laser);
  const MountError camera_error(camera_mount, scenario.seed, camera), laser_error(laser_config.mount, scenario.seed, laser);
  CalibrationTruth truth;
  truth.X_BC = laser_config.mount.X_BL() * laser_error.X_BL(0, 0.0).inverse() * camera_error.X_BC(0, 0.0);
  truth.range_bias_m = LaserNoiseModel(laser_config, scenario.seed, laser).bias_m();
  return truth;
}

CalibrationError error_of(const Pose& X_BC, const Pose& X_BC_true, const Eigen::Matrix<double, 6, 6>& covariance) {
  CalibrationError error;
  error.shift_B = X_BC.translation() - X_BC_true.translation();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_BC.linear() * X_BC_true.linear().transpose()));
  error.turn_B = turn.angle() * turn.axis();
  Eigen::Matrix<double, 6, 1> both;
  both << error.shift_B, error.turn_B;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(covariance);
  error.chi2 = factor.info() == Eigen::Success ? both.dot(factor.solve(both)) : std::nan("");
  return error;
}

std::string calibration_text(const Calibration& calibration, const std::optional<CalibrationTruth>& truth) {
  const Refined& found = calibration.found;
  const Extrinsics e = extrinsics_of(calibration);
  std::string text;
  add_line(text, "%d of %zu board poses used, %d beams on them; what is left: %.2f mm along the beams, %.3f px at the corners",
           calibration.used_poses, calibration.poses.size(), found.points, 1e3 * found.rms_m, found.corner_sigma_px);
  for (std::size_t i = 0; i < calibration.poses.size(); ++i) {
    const PoseReport& pose = calibration.poses[i];
    if (!pose.unused.empty()) add_line(text, "  pose %zu, at %.1f s, was not used: %s", i + 1, pose.at_s, pose.unused.c_str());
  }
  add_line(text, "camera %s on the vehicle (laser %s stays):", calibration.camera.c_str(), calibration.laser.c_str());
  add_line(text, "  x %.4f, y %.4f, z %.4f m, +- %.1f, %.1f, %.1f mm", e.mount.x_m, e.mount.y_m, e.mount.z_m, 1e3 * e.sigma_m[0],
           1e3 * e.sigma_m[1], 1e3 * e.sigma_m[2]);
  add_line(text, "  yaw %.3f, pitch %.3f, roll %.3f deg, +- %.3f, %.3f, %.3f deg about x, y, z", e.mount.yaw_deg, e.mount.pitch_deg,
           e.mount.roll_deg, e.sigma_deg[0], e.sigma_deg[1], e.sigma_deg[2]);
  if (found.covariance(6, 6) > 0.0) {
    add_line(text, "  ranges read %.1f +- %.1f mm too long", 1e3 * e.range_bias_m, 1e3 * e.range_bias_sigma_m);
  }
  const CalibrationError moved = waretwin::error_of(found.X_BC, calibration.X_BC_given, Eigen::Matrix<double, 6, 6>::Identity());
  add_line(text, "that is %.1f mm and %.2f deg from where it was taken to be", 1e3 * moved.shift_B.norm(), to_degrees(moved.turn_B.norm()));
  if (truth) {
    const CalibrationError error = error_of(calibration, found.X_BC, *truth),
                           before = error_of(calibration, calibration.X_BC_given, *truth);
    add_line(text, "against the truth: %.2f mm and %.3f deg wrong (chi2 %.1f of 6); before: %.1f mm and %.2f deg",
             1e3 * error.shift_B.norm(), to_degrees(error.turn_B.norm()), error.chi2, 1e3 * before.shift_B.norm(),
             to_degrees(before.turn_B.norm()));
    if (found.covariance(6, 6) > 0.0) add_line(text, "  ranges truly read %.1f mm too long", 1e3 * truth->range_bias_m);
  }
  if (calibration.lens) {
    const LensEstimate& lens = *calibration.lens;
    const double given[] = {calibration.given.fx, calibration.given.fy, calibration.given.cx, calibration.given.cy, 0, 0, 0, 0};
    add_line(text, "intrinsics from %d poses (%.3f px left), beside those that the mapper goes by:", lens.poses, lens.rms_px);
    for (int i = 0; i < 8; ++i) {
      if (lens.sigmas[i] > 0.0) add_line(text, "  %s %.4f +- %.4f, given %.4f", kLensNames[i], lens.values[i], lens.sigmas[i], given[i]);
    }
  }
  return text;
}

std::string calibration_json(const Calibration& calibration, const std::optional<CalibrationTruth>& truth) {
  const Refined& found = calibration.found;
  const Extrinsics e = extrinsics_of(calibration);
  Json json = {{"schema", 1},
               {"version", kVersion},
               {"camera", e.camera},
               {"laser", e.laser},
               {"X_BC", e.X_BC},
               {"X_BL", e.X_BL},
               {"sigma_m", e.sigma_m},
               {"sigma_deg", e.sigma_deg},
               {"range_bias_m", e.range_bias_m},
               {"range_bias_sigma_m", e.range_bias_sigma_m},
               {"poses_used", calibration.used_poses},
               {"points", found.points},
               {"beam_rms_m", found.rms_m},
               {"beam_factor", found.beam_factor},
               {"corner_sigma_px", found.corner_sigma_px},
               {"frames", calibration.frames},
               {"frames_with_board", calibration.frames_with_board}};
  for (const PoseReport& pose : calibration.poses) {
    json["poses"].push_back({{"at_s", pose.at_s},
                             {"frames", pose.frames},
                             {"scans", pose.scans},
                             {"points", pose.points},
                             {"corner_rms_px", pose.corner_rms_px},
                             {"point_rms_m", pose.point_rms_m},
                             {"used", pose.unused.empty()},
                             {"reason", pose.unused}});
  }
  if (calibration.lens) {
    for (int i = 0; i < 8; ++i) {
      json["intrinsics"][kLensNames[i]] = {{"value", calibration.lens->values[i]}, {"sigma", calibration.lens->sigmas[i]}};
    }
    json["intrinsics"]["rms_px"] = calibration.lens->rms_px;
    json["intrinsics"]["given"] = {calibration.given.fx, calibration.given.fy, calibration.given.cx, calibration.given.cy};
  }
  if (truth) {
    const CalibrationError error = error_of(calibration, found.X_BC, *truth);
    json["truth"] = {{"X_BC", pose_numbers(truth->X_BC)}, {"range_bias_m", truth->range_bias_m}};
    json["error"] = error_json(error);
    if (std::isfinite(error.chi2)) json["error"]["chi2"] = error.chi2;
    json["error_before"] = error_json(error_of(calibration, calibration.X_BC_given, *truth));
  }
  return json.dump(1) + "\n";
}

}  // namespace waretwin
