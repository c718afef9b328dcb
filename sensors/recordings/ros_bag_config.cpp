#include "sensors/recordings/ros_bag_config.h"

namespace waretwin {

RosBagConfig RosBagConfig::of_preset(const std::string& name) {
  RosBagConfig config;
  config.preset = name;
  if (name == "agiprobot") {
    // The authors' published node: /camera/rgb/image_raw, /camera/depth_registered/image_raw, base_link.
    config.colour_topic = "/camera/rgb/image_raw";
    config.colour_info_topic = "/camera/rgb/camera_info";
    config.depth_topic = "/camera/depth_registered/image_raw";
  } else if (name == "azure_kinect") {
    config.colour_topic = "/rgb/image_raw";
    config.colour_info_topic = "/rgb/camera_info";
    config.depth_topic = "/depth_to_rgb/image_raw";
  }
  return config;
}

void RosBagConfig::visit(Fields& f) {
  const std::string before = preset;
  f("preset", preset, "topics of a known robot or driver, before the keys below", {.choices = {"auto", "agiprobot", "azure_kinect"}});
  if (preset != before) *this = of_preset(preset);
  f("colour_topic", colour_topic, "sensor_msgs/Image or CompressedImage; empty = the only one with colours");
  f("colour_info_topic", colour_info_topic, "sensor_msgs/CameraInfo; empty = the one beside the colour topic, else the only one");
  f("depth_topic", depth_topic, "depth registered to the colour picture; empty = the only one, or the only one whose name says so");
  f("native_depth_topic", native_depth_topic,
    "the depth camera's own images, before they were registered; none, or empty = the only other depth topic of the same device");
  f("laser_topic", laser_topic, "sensor_msgs/LaserScan; none, or empty = the only one");
  f("odometry_topic", odometry_topic, "nav_msgs/Odometry; none, or empty = the only one");
  f("base_frame", base_frame, "the vehicle's frame in tf");
  f("world_frame", world_frame, "frame of the poses that tf recorded, e.g. map; empty = none");
  f("camera_frame", camera_frame, "the camera's optical frame in tf; empty = the messages' own");
  f("laser_frame", laser_frame, "the laser's frame in tf; empty = the messages' own");
  f("rectified", rectified, "whether the pictures are without the distortion that camera_info names; auto = by the topic's name",
    {.choices = {"auto", "yes", "no"}});
  f("registered", registered, "whether depth is in the colour picture's view; auto = refused where camera_info or tf say that it is not",
    {.choices = {"auto", "yes"}});
}

void RosBagFormat::visit(Fields& f) {
  f("images", images, "raw, or compressed as PNG", {.choices = {"raw", "compressed"}});
  f("compression", compression, "of the bag's chunks", {.choices = {"none", "lz4", "bz2"}});
}

}  // namespace waretwin
