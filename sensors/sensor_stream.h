// One stream, many sources: the simulation, a TUM folder, a 7-Scenes folder all yield time-ordered events.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "core/pose.h"
#include "sensors/intrinsics.h"
#include "sensors/lens.h"
#include "sensors/measurements.h"

namespace waretwin {

using SensorEvent = std::variant<OdometryReading, LaserScan, RgbdFrame>;

Stamp stamp_of(const SensorEvent& event);

// A depth camera D that has a lens of its own beside the colour camera C.
struct DepthCameraView {
  Lens lens;
  Pose X_CD = Pose::Identity();
};

// What a mapper may know about a source before the first event: calibration and where the robot stands. No truth.
struct StreamInfo {
  struct Camera {
    Intrinsics intrinsics;
    Pose X_BC = Pose::Identity();
    double depth_min_m = 0.0;  // metres; depth outside [min, max] is not trusted
    double depth_max_m = 0.0;
    double rate_hz = 0.0;  // nominal
    // The depth camera's own view, where frames carry native_depth.
    std::optional<DepthCameraView> native = std::nullopt;
  };
  struct Laser {
    Pose X_BL = Pose::Identity();
    double rate_hz = 0.0;  // nominal
  };

  std::string source;  // scenario or folder name, for reports
  std::map<std::string, Camera> cameras;
  std::map<std::string, Laser> lasers;
  bool has_odometry = false;
  bool has_recorded_poses = false;
  // Pose of the vehicle at the first event. The simulation's world is the hall's; a recording's is whatever its poses use.
  Pose X_WB_start = Pose::Identity();
  // Unit vector that points up in the recording's own world.
  Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
  // What of B's space the vehicle itself takes up, where its sensors see it: whatever is measured in this box is the vehicle.
  std::optional<Eigen::AlignedBox3d> own_body_B;
  std::optional<int> frame_count;    // camera frames, where known before the end
  std::optional<double> duration_s;  // where known before the end
};

class SensorStream {
 public:
  virtual ~SensorStream() = default;
  virtual const StreamInfo& info() const = 0;
  // The next event in order of stamps, nothing at the end. Throws Error where a recording is damaged.
  virtual std::optional<SensorEvent> next() = 0;
};

}  // namespace waretwin
