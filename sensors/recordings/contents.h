// What a recording of any layout holds, before it becomes a stream. Internal to sensors/recordings.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sensors/lens.h"
#include "sensors/recordings/recording.h"

namespace waretwin {

// A picture as it is stored: colour as CV_8UC3 (BGR); depth as CV_16UC1 in the layout's units or CV_32FC1 in metres.
struct StoredImage {
  std::string name;               // its file, or topic and stamp, for errors
  std::function<cv::Mat()> read;  // throws Error naming it where it is missing or damaged; empty: there is none

  explicit operator bool() const { return static_cast<bool>(read); }
};
StoredImage stored_colour(const std::filesystem::path& file);
StoredImage stored_depth(const std::filesystem::path& file);

struct RecordedFrame {
  Stamp stamp = 0;  // of the colour picture
  Stamp depth_stamp = 0;
  StoredImage colour, depth;
  StoredImage native_depth = {};
  std::optional<Pose> X_WC = std::nullopt;
};

struct RecordingContents {
  std::vector<RecordedFrame> frames;  // sorted by stamp
  std::vector<LaserScan> scans;
  std::vector<OdometryReading> readings;
  bool has_laser = false, has_odometry = false;  // even where no message came

  std::vector<double> intrinsics;         // fx, fy, cx, cy of the pictures as stored
  Distortion distortion;                  // of the pictures as stored
  std::optional<DepthCameraView> native;  // of native_depth, where the layout says it
  std::string native_list;                // the file that names native_depth; then a lens for it must be known
  double depth_scale = 1000.0;            // of the layout
  double rate_hz = 30.0, laser_rate_hz = 25.0;
  std::optional<Pose> X_BC, X_BL;  // where the layout says them
  Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();

  int lost_frames = 0;
  std::vector<std::string> remarks, sources;
};

// `calibration` (recording.yaml) wins over what the layout says, `config` over both.
std::unique_ptr<Recording> make_stream(RecordingContents contents, const std::optional<RecordingCalibration>& calibration,
                                       const RecordingConfig& config, const std::string& source);

bool is_frame_folder(const std::filesystem::path& folder);
RecordingContents read_frame_folder(const std::filesystem::path& folder, const RecordingConfig& config);

bool is_scenenn_folder(const std::filesystem::path& folder);
RecordingContents read_scenenn_folder(const std::filesystem::path& folder, const RecordingConfig& config);

bool is_tum_folder(const std::filesystem::path& folder);
RecordingContents read_tum_folder(const std::filesystem::path& folder, const RecordingConfig& config);

// The pose made orthonormal; nothing where its rotation is more than 0.01 away from one or is a mirror image.
std::optional<Pose> rigid_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

}  // namespace waretwin
