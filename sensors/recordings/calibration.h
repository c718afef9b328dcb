// What a recording says of its sensors beside their readings: recording.yaml, which may stand in any recording's folder.
#pragma once

#include <string>
#include <vector>

#include "core/fields.h"
#include "core/pose.h"
#include "sensors/lens.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// What recording.yaml holds. Poses are the upper three rows of their 4 x 4 matrix, row by row.
struct RecordingCalibration {
  struct Native {  // the depth camera's own view
    int width = 0, height = 0;
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // pixels
    Distortion distortion;
    std::vector<double> X_CD = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    void visit(Fields& f);
  };
  struct Camera {
    std::string name = "camera";
    int width = 0, height = 0;
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // pixels
    double depth_min_m = 0.4, depth_max_m = 5.0;
    double depth_scale = 5000.0;  // units of a depth image in one metre
    double rate_hz = 30.0;
    std::vector<double> X_BC = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    bool has_native = false;
    Native native;
    void visit(Fields& f);
  };
  struct Laser {
    std::string name = "laser";
    double rate_hz = 25.0;
    std::vector<double> X_BL = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    void visit(Fields& f);
  };
  bool has_camera = false, has_laser = false;
  Camera camera;
  Laser laser;
  std::vector<double> X_WB_start = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::vector<double> up = {0, 0, 1};
  std::vector<double> own_body;  // StreamInfo::own_body_B: least x, y, z, most x, y, z in metres; empty: none
  void visit(Fields& f);
};

// The twelve numbers of a pose in recording.yaml, and back. The way back throws Error for what is no rigid motion.
std::vector<double> pose_numbers(const Pose& pose);
Pose pose_from_numbers(const std::vector<double>& numbers);

// What recording.yaml says of a stream. Throws Error where it cannot hold it: it has room for one camera and one laser, and is no
// recording without either.
RecordingCalibration calibration_of(const StreamInfo& info);

}  // namespace waretwin
