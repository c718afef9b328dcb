#include "sensors/recordings/recording.h"

#include "core/config.h"
#include "core/error.h"
#include "core/own_name.h"
#include "sensors/recordings/carmen_log.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/recorded_image.h"
#include "sensors/recordings/ros_bag.h"
#include "sensors/recordings/stamped_files.h"
#include "sensors/recordings/text_formats.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

// The layout of a folder whose pictures are files; nothing where it is none.
std::optional<RecordingContents> read_pictures(const fs::path& folder, const RecordingConfig& config) {
  if (is_tum_folder(folder)) return read_tum_folder(folder, config);
  if (is_frame_folder(folder)) return read_frame_folder(folder, config);
  if (is_scenenn_folder(folder)) return read_scenenn_folder(folder, config);
  return std::nullopt;
}

// The depth camera's own images, each to the frame whose stamp is nearest.
void add_native_depth(const fs::path& folder, const RecordingConfig& config, RecordingContents& contents) {
  const fs::path list = folder / "depth_native.txt";
  if (!fs::exists(list)) return;
  std::vector<StampedFile> natives = read_file_list(list);
  for (StampedFile& native : natives) native.stamp += depth_delay(config);
  if (!natives.empty()) contents.native_list = list.filename().string();
  for (RecordedFrame& frame : contents.frames) {
    if (natives.empty()) break;
    const StampedFile& near = natives[nearest_stamp(natives, frame.depth_stamp)];
    if (std::abs(near.stamp - frame.depth_stamp) <= from_seconds(config.association_s)) frame.native_depth = stored_depth(near.file);
  }
}

RecordingContents read_folder(const fs::path& folder, const RecordingConfig& config) {
  std::optional<RecordingContents> pictures = read_pictures(folder, config);
  // Datasets ship a bag beside their pictures: the pictures are then the recording.
  if (const std::optional<fs::path> bag = pictures ? std::nullopt : bag_in(folder)) return read_ros_bag(*bag, config);
  const fs::path laser_file = folder / "laser.txt", odometry_file = folder / "odometry.txt";
  if (!pictures && !fs::exists(laser_file)) {
    throw Error(folder,
                "is no recording; expected rgb.txt and depth.txt (TUM), frame-NNNNNN.color.png with camera-intrinsics.txt (7-Scenes), "
                "image/imageNNNNN.png with depth/depthNNNNN.png (SceneNN), a .bag (ROS 1), or laser.txt");
  }
  RecordingContents contents = pictures ? std::move(*pictures) : RecordingContents();
  if (pictures) add_native_depth(folder, config, contents);
  if (fs::exists(odometry_file)) {
    contents.readings = read_odometry_file(odometry_file, "odometry");
    contents.has_odometry = true;
  }
  if (fs::exists(laser_file)) {
    contents.scans = read_laser_file(laser_file, "laser");
    contents.has_laser = true;
  }
  return contents;
}

}  // namespace

StoredImage stored_colour(const fs::path& file) {
  return {file.string(), [file] { return read_colour_image(file); }};
}

StoredImage stored_depth(const fs::path& file) {
  return {file.string(), [file] { return read_depth_image(file); }};
}

bool is_carmen_log(const fs::path& file) {
  if (!fs::is_regular_file(file)) return false;
  const fs::path name = file.extension() == ".gz" ? file.stem() : file;
  return name.extension() == ".log" || name.extension() == ".clf";
}

bool is_recording_file(const fs::path& file) { return is_carmen_log(file) || is_ros_bag(file); }

std::unique_ptr<Recording> open_recording(const fs::path& path, const RecordingConfig& config) {
  if (!fs::exists(path)) throw Error(path, "no such folder, log or bag");
  if (is_carmen_log(path)) return make_stream(read_carmen_log(path), std::nullopt, config, own_name(path));
  const bool bag = is_ros_bag(path);
  if (!bag && !fs::is_directory(path)) {
    throw Error(path, "is not a folder; expected a recording's folder, a CARMEN log (.log, .log.gz) or a ROS 1 bag (.bag)");
  }
  RecordingContents contents = bag ? read_ros_bag(path, config) : read_folder(path, config);
  std::optional<RecordingCalibration> calibration;
  const fs::path calibration_file = (bag ? path.parent_path() : path) / "recording.yaml";
  if (fs::exists(calibration_file)) {
    calibration.emplace();
    read_config_into(calibration_file, *calibration);
  }
  return make_stream(std::move(contents), calibration, config, own_name(path));
}

}  // namespace waretwin
