// ROS 1 bags. A build without librosbag-storage has these functions, too; those that read or write then throw one Error that says so.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "sensors/recordings/contents.h"
#include "sensors/recordings/recording_writer.h"

namespace waretwin {

// Whether a path is a file called .bag.
bool is_ros_bag(const std::filesystem::path& file);
// The bag of a folder that holds one; nothing where there is none. Throws Error where there are several.
std::optional<std::filesystem::path> bag_in(const std::filesystem::path& folder);

// Topics by RosBagConfig:
//   colour      sensor_msgs/Image (bgr8, rgb8, bgra8, rgba8, mono8, 8UC3, 8UC4) or CompressedImage (PNG, JPEG)
//   depth       sensor_msgs/Image (16UC1, mono16: units of depth_scale, by default millimetres; 32FC1: metres, NaN = none) or
//               CompressedImage (compressedDepth of either kind, or a PNG), registered to the colour picture and of its size
//   camera_info the first one of the colour camera: K, and D where the pictures are not rectified
//   laser       sensor_msgs/LaserScan; what is not in [range_min, range_max] becomes 0
//   odometry    nav_msgs/Odometry: x, y and heading (rounded to nanoradians, so that our own come back exactly)
//   tf          where camera and laser are on the vehicle, and with world_frame the recorded poses, interpolated between two messages at
//               most max_pose_gap_s apart
// Stamps are those of the messages' headers; messages may come in any order, those of a stamp that was there before are left out, and
// pictures without a partner within association_s are, too; remarks say how many. Pictures stay in the file until a frame is loaded.
// Throws Error for a damaged or unindexed bag, for a topic whose messages all have one stamp, for a topic that is missing, ambiguous or of
// another type (naming the key and what is there), for encodings that are not read, and where tf does not connect the vehicle with a sensor
// that has no mount otherwise.
RecordingContents read_ros_bag(const std::filesystem::path& file, const RecordingConfig& config);

// recording.bag in the folder; recording_writer.h lists its topics. Equal streams give equal bytes.
std::unique_ptr<RecordingWriter> make_bag_writer(const std::filesystem::path& folder, const StreamInfo& info, const RosBagFormat& format);

}  // namespace waretwin
