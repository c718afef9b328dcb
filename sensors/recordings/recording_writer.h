// A sensor stream as a recording that open_recording reads back to the same bits.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sensors/recordings/recording.h"
#include "sensors/recordings/ros_bag_config.h"

namespace waretwin {

// Everything goes to disk at once, so that a long drive takes no more memory than a short one.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  // Events of the stream in its order; a frame's pictures are loaded. Throws Error where the disk is full.
  virtual void add(const OdometryReading& reading) = 0;
  virtual void add(const LaserScan& scan) = 0;
  virtual void add(const RgbdFrame& frame) = 0;
  // Closes the files; nothing may be added after it. Throws Error where not everything reached the disk.
  virtual void finish() = 0;
};

// The layouts that can be written (recording.h describes them), each with recording.yaml beside it:
//   tum      rgb.txt and rgb/, depth.txt and depth/, depth_native.txt and depth_native/ where the camera has a view of its own, laser.txt,
//            odometry.txt
//   7scenes  frame-NNNNNN.color.png, .depth.png and .pose.txt, camera-intrinsics.txt, stamps.txt; laser, odometry and native depth as above
//   scenenn  image/, depth/, timestamp.txt, trajectory.log, stamps.txt; the rest as above
//   rosbag   recording.bag: /camera/rgb/{image_raw,camera_info}, /camera/depth_registered/{image_raw,camera_info},
//            /camera/depth/{image_raw,camera_info} where the camera has a view of its own, /scan, /odom, /tf (odom to base_link),
//            /tf_static
// Depth is in millimetres. Poses are written where frames have them (RgbdFrame::recorded_X_WC), in tum as groundtruth.txt; a bag has none.
const std::vector<std::string>& recording_formats();

// Into an empty folder; `source` is the comment at the top of recording.yaml. Throws Error as calibration_of does, for an unknown format,
// where the folder cannot be written, and for rosbag in a build without librosbag-storage.
std::unique_ptr<RecordingWriter> make_recording_writer(const std::string& format, const std::filesystem::path& folder,
                                                       const StreamInfo& info, const std::string& source, const RosBagFormat& bag = {});

// Whether a file or folder of this name in a recording's folder may be of the recording.
bool is_recording_part(const std::string& name);

}  // namespace waretwin
