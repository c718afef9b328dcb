#include "sensors/recordings/recording_writer.h"

#include <algorithm>
#include <set>

#include "core/config.h"
#include "core/error.h"
#include "core/files.h"
#include "sensors/recordings/folder_writer.h"
#include "sensors/recordings/ros_bag.h"

namespace waretwin {

const std::vector<std::string>& recording_formats() {
  static const std::vector<std::string> formats = {"tum", "scenenn", "rosbag", "7scenes"};
  return formats;
}

std::unique_ptr<RecordingWriter> make_recording_writer(const std::string& format, const std::filesystem::path& folder,
                                                       const StreamInfo& info, const std::string& source, const RosBagFormat& bag) {
  RecordingCalibration calibration = calibration_of(info);
  std::unique_ptr<RecordingWriter> writer;
  if (format == "rosbag") {
    writer = make_bag_writer(folder, info, bag);
  } else {
    writer = make_folder_writer(format, folder, info);
  }
  write_file(folder / "recording.yaml", "# " + source + "\n" + write_config([&](Fields& f) { calibration.visit(f); }));
  return writer;
}

bool is_recording_part(const std::string& name) {
  static const std::set<std::string> names = {"rgb",
                                              "depth",
                                              "depth_native",
                                              "rgb.txt",
                                              "depth.txt",
                                              "image",
                                              "stamps.txt",
                                              "timestamp.txt",
                                              "trajectory.log",
                                              "depth_native.txt",
                                              "laser.txt",
                                              "odometry.txt",
                                              "recording.yaml",
                                              "recording.bag",
                                              "camera-intrinsics.txt",
                                              "groundtruth.txt"};
  if (names.contains(name)) return true;
  return name.starts_with("frame-") && (name.ends_with(".color.png") || name.ends_with(".depth.png") || name.ends_with(".pose.txt"));
}

}  // namespace waretwin
