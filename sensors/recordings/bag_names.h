// Topics and frames of the bags that we write: those of the authors' robot (their published node), with the depth camera's own view beside.
#pragma once

namespace waretwin::bag_names {

inline constexpr const char* kColour = "/camera/rgb/image_raw";
inline constexpr const char* kColourInfo = "/camera/rgb/camera_info";
inline constexpr const char* kDepth = "/camera/depth_registered/image_raw";
inline constexpr const char* kDepthInfo = "/camera/depth_registered/camera_info";
inline constexpr const char* kNativeDepth = "/camera/depth/image_raw";
inline constexpr const char* kNativeInfo = "/camera/depth/camera_info";
inline constexpr const char* kLaser = "/scan";
inline constexpr const char* kOdometry = "/odom";
inline constexpr const char* kTf = "/tf";
inline constexpr const char* kTfStatic = "/tf_static";

inline constexpr const char* kBaseFrame = "base_link";
inline constexpr const char* kOdometryFrame = "odom";
inline constexpr const char* kLaserFrame = "laser";
inline constexpr const char* kColourFrame = "camera_rgb_optical_frame";
inline constexpr const char* kDepthFrame = "camera_depth_optical_frame";

}  // namespace waretwin::bag_names
