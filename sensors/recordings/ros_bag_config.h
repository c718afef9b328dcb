// Which topics and frames of a ROS bag are the camera, the laser and the odometry.
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

struct RosBagConfig {
  // agiprobot: the topics and frames of the authors' robot, whose camera hangs upside down; azure_kinect: those of the Azure Kinect ROS
  // driver; auto: whatever topic is the only one of its type (for depth: of those registered to the colour picture).
  std::string preset = "auto";
  // Empty: found by type. "none" for laser_topic and odometry_topic: not read.
  std::string colour_topic, colour_info_topic, depth_topic, laser_topic, odometry_topic;
  // The depth camera's own images; "none": not read, empty: the only other depth topic of the same device.
  std::string native_depth_topic;
  std::string base_frame = "base_link";
  // Where tf says how the vehicle stands in this frame, recorded poses come from it (--poses recorded); empty: none.
  std::string world_frame;
  // Empty: the frame that the messages' headers name.
  std::string camera_frame, laser_frame;
  // Whether pictures are distorted as camera_info says: auto = unless the topic's name says "rect".
  std::string rectified = "auto";
  // Whether depth is in the colour picture's view: auto = unless camera_info or tf say otherwise (then it is refused).
  std::string registered = "auto";
  // Topics that a preset names are taken where the bag has them.
  static RosBagConfig of_preset(const std::string& name);
  void visit(Fields& f);
};

// How bags are written.
struct RosBagFormat {
  std::string images = "raw";        // raw: sensor_msgs/Image; compressed: sensor_msgs/CompressedImage, as PNG
  std::string compression = "none";  // of the bag's chunks: none, lz4, bz2
  void visit(Fields& f);
};

}  // namespace waretwin
