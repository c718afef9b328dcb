// Recordings of real or simulated drives as sensor streams.
//
// Four layouts, told apart by their files:
//   frames  (7-Scenes, 3DMatch)  frame-NNNNNN.color.png|jpg, frame-NNNNNN.depth.png, frame-NNNNNN.pose.txt (4 x 4, camera to world; may
//           be missing for all frames), camera-intrinsics.txt (3 x 3). Stamps are number / frame_rate_hz. Depth in millimetres. A pose
//           that is not finite marks a lost camera: the frame is left out and counted.
//   tum     (TUM RGB-D)          rgb.txt and depth.txt (lines "seconds file"), groundtruth.txt ("seconds x y z qx qy qz qw", camera to
//           world; may be missing). A picture and a depth image belong together when each is the other's nearest, within
//           association_s. Poses are interpolated between two at most max_pose_gap_s apart; in longer gaps and beyond the ends a frame
//           takes the nearest one within association_s, else it has none. Depth in units of 1 / 5000 m. Intrinsics from recording.yaml,
//           else from calibration.txt ("fx fy cx cy", further numbers are ignored), else those of the Freiburg 1 camera.
//   scenenn (SceneNN, Hua et al. 2016)  image/imageNNNNN.png and depth/depthNNNNN.png, numbered from 1 as the dataset's playback tool
//           writes them; timestamp.txt ("number colour_us depth_us", may be missing: then number / frame_rate_hz); trajectory.log (a
//           line "i i i+1" for frame i + 1 and its 4 x 4 matrix, camera to world; may be missing). Depth in millimetres. Intrinsics from
//           recording.yaml, else from asus.ini or kinect2.ini here, in intrinsic/ or in the parent's intrinsic/ (lines "fx 544.47"),
//           else those of the dataset's Asus camera. The annotation (NAME.xml) is truth and is never read here.
//   bag     (ROS 1)              one .bag, by itself or in a folder; ros_bag.h.
// Depth images hold 16-bit units (0 and 65535 are invalid, and what depth_invalid names) or 32-bit floats in metres (TIFF).
//
// Beside any of them may stand what our own recordings add:
//   recording.yaml  calibration and start pose, exact (calibration.h). It wins over what the layout says.
//   laser.txt and odometry.txt  (not for bags) text_formats.h.
//   stamps.txt      (frames, scenenn) lines "number seconds", the exact stamp of each frame.
//   depth_native.txt  (not for bags) lines "seconds file" of the depth camera's own images, before they were warped into the colour view;
//                   in the units of the other depth images, in the lens that recording.yaml names under camera.native.
// A folder with laser.txt alone is a laser log, and so is a CARMEN log, which is one file (FILE.log, FILE.log.gz; carmen_log.h). Lines that
// begin with # and empty lines are comments in all text files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/fields.h"
#include "sensors/recordings/calibration.h"
#include "sensors/recordings/ros_bag_config.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// Seconds that are added to a sensor's stamps: by how much its clock is behind the others'. Recorded poses are by the right clock.
struct ClockOffsets {
  double colour_s = 0.0, depth_s = 0.0, laser_s = 0.0, odometry_s = 0.0;
  void visit(Fields& f);
};

struct RecordingConfig {
  // Unit vector that points up in the recording's world. Empty: recording.yaml's; without one z for tum and bags, and for frames and
  // scenenn the axis nearest to the mean direction of the cameras' upper edges (y points down in 7-Scenes and up in SUN3D).
  std::vector<double> up;
  std::vector<double> start;         // x_m, y_m, yaw_deg of the vehicle at the first event; empty: the recording's, else 0, 0, 0
  std::vector<double> camera_mount;  // x_m, y_m, z_m, yaw_deg, pitch_deg, roll_deg (as in Mount) of the upright pictures' camera on the
  std::vector<double> laser_mount;   // vehicle, and of the laser; empty: the recording's, else at its base
  std::vector<double> intrinsics;    // fx, fy, cx, cy in pixels in place of the recording's own; empty: the recording's
  int rotate_deg = 0;  // clockwise turn that makes the pictures upright, of a camera that is mounted otherwise: 0, 90, 180 or 270
  double depth_min_m = 0.0, depth_max_m = 0.0;  // depth outside is not trusted; 0: the recording's, else 0.4 and 5
  double depth_scale = 0.0;                     // units of a 16-bit depth image in one metre; 0: 1000, for tum 5000
  std::vector<double> depth_invalid;            // units that mean "nothing measured", beside 0 and 65535
  double frame_rate_hz = 30.0;
  double association_s = 0.02;
  // Recorded poses are interpolated between two that are at most so far apart (tum, bags). Half a second: a vehicle that brakes with 1
  // m/s^2 is then at most 3 cm beside the straight line.
  double max_pose_gap_s = 0.5;
  ClockOffsets clock;
  RosBagConfig bag;
  void visit(Fields& f);
};

class Recording : public SensorStream {
 public:
  // Frames that were left out because their camera was lost.
  virtual int lost_frames() const = 0;
  // What else was left out or mended on the way in (pictures without depth, stamps out of order), a sentence each.
  virtual const std::vector<std::string>& remarks() const = 0;
  // Which of a bag's topics are what, a line each; empty for other recordings.
  virtual const std::vector<std::string>& sources() const = 0;
};

// Whether a path is a file that open_recording takes for a CARMEN log: .log, .log.gz, .clf or .clf.gz.
bool is_carmen_log(const std::filesystem::path& file);
// Whether it is one file that open_recording takes: a CARMEN log or a bag.
bool is_recording_file(const std::filesystem::path& file);

// Opens a folder, a CARMEN log or a bag. Pictures are decoded by RgbdFrame::load. Throws one Error for a folder of no known layout (naming
// what was looked for) and for whatever in it is missing or damaged; pictures are checked when they are loaded. Without recording.yaml the
// vehicle's base is the camera (X_BC = identity) and starts at the first recorded pose.
std::unique_ptr<Recording> open_recording(const std::filesystem::path& folder, const RecordingConfig& config = {});

}  // namespace waretwin
