// What a folder of either layout holds, before it becomes a stream. Internal to sensors/recordings.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "sensors/recordings/recording.h"

namespace waretwin {

struct RecordedFrame {
  Stamp stamp = 0;
  std::filesystem::path colour;
  std::filesystem::path depth;
  std::filesystem::path native_depth;  // empty: none
  std::optional<Pose> X_WC;
};

struct RecordingContents {
  std::vector<RecordedFrame> frames;  // sorted by stamp
  std::vector<double> intrinsics;     // fx, fy, cx, cy
  double depth_scale = 1000.0;        // of the layout
  double rate_hz = 30.0;
  int lost_frames = 0;
  Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
};

bool is_frame_folder(const std::filesystem::path& folder);
RecordingContents read_frame_folder(const std::filesystem::path& folder, const RecordingConfig& config);

bool is_tum_folder(const std::filesystem::path& folder);
RecordingContents read_tum_folder(const std::filesystem::path& folder, const RecordingConfig& config);

// The pose made orthonormal; nothing where its rotation is more than 0.01 away from one or is a mirror image.
std::optional<Pose> rigid_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

}  // namespace waretwin
