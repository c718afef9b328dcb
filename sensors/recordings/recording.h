// Recordings of real or simulated drives as sensor streams.
//
// Two layouts, told apart by their files:
//   frames  (7-Scenes, 3DMatch)  frame-NNNNNN.color.png|jpg, frame-NNNNNN.depth.png, frame-NNNNNN.pose.txt (4 x 4, camera to world; may
//           be missing for all frames), camera-intrinsics.txt (3 x 3). Stamps are number / frame_rate_hz. Depth in millimetres; 0 and
//           65535 are invalid. A pose that is not finite marks a lost camera: the frame is left out and counted.
//   tum     (TUM RGB-D)          rgb.txt and depth.txt (lines "seconds file"), groundtruth.txt ("seconds x y z qx qy qz qw", camera to
//           world; may be missing). A picture and a depth image belong together when each is the other's nearest, within
//           association_s. Depth in units of 1 / 5000 m, 0 invalid. Intrinsics from recording.yaml, else from calibration.txt
//           ("fx fy cx cy", further numbers are ignored), else those of the Freiburg 1 camera.
// Beside either may stand what our own recordings add:
//   recording.yaml  calibration and start pose, exact (RecordingCalibration below); laser.txt and odometry.txt (text_formats.h).
//   depth_native.txt  (tum) lines "seconds file" of the depth camera's own images, before they were warped into the colour view; in the
//                   units of the other depth images, in the lens that recording.yaml names under camera.native.
// A folder with laser.txt alone is a laser log, and so is a CARMEN log, which is one file (FILE.log, FILE.log.gz; carmen_log.h). Lines that
// begin with # and empty lines are comments in all text files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/fields.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

struct RecordingConfig {
  // Unit vector that points up in the recording's world. Empty: recording.yaml's; without one z for tum, and for frames the axis nearest
  // to the mean direction of the cameras' upper edges (y points down in 7-Scenes and up in SUN3D).
  std::vector<double> up;
  std::vector<double> intrinsics;  // fx, fy, cx, cy in pixels in place of the recording's own; empty: the recording's
  double depth_min_m = 0.4, depth_max_m = 5.0;
  double depth_scale = 0.0;  // units of a depth image in one metre; 0: 1000 for frames, 5000 for tum
  double frame_rate_hz = 30.0;
  double association_s = 0.02;
  void visit(Fields& f);
};

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

class Recording : public SensorStream {
 public:
  // Frames that were left out because their camera was lost.
  virtual int lost_frames() const = 0;
};

// Whether a path is a file that open_recording takes for a CARMEN log: .log, .log.gz, .clf or .clf.gz.
bool is_carmen_log(const std::filesystem::path& file);

// Opens a folder or a CARMEN log. Pictures are decoded by RgbdFrame::load. Throws one Error for a folder of no known layout (naming what
// was looked for) and for whatever in it is missing or damaged; pictures are checked when they are loaded. Without recording.yaml the
// vehicle's base is the camera (X_BC = identity) and starts at the first recorded pose.
std::unique_ptr<Recording> open_recording(const std::filesystem::path& folder, const RecordingConfig& config = {});

}  // namespace waretwin
