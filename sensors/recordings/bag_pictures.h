// Pictures of ROS messages. Internal to sensors/recordings; compiled where librosbag-storage was found.
#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core/mat.hpp>
#include <string>

namespace waretwin {

// Whether an encoding is one of depth (16UC1, mono16, 32FC1) or of colours; throws nothing for others, they are neither.
bool is_depth_encoding(const std::string& encoding);
bool is_colour_encoding(const std::string& encoding);

// CV_8UC3, BGR. Throw Error naming `name` and what the message holds.
cv::Mat colour_of(const sensor_msgs::Image& message, const std::string& name);
cv::Mat colour_of(const sensor_msgs::CompressedImage& message, const std::string& name);
// CV_16UC1 in units or CV_32FC1 in metres.
cv::Mat depth_of(const sensor_msgs::Image& message, const std::string& name);
cv::Mat depth_of(const sensor_msgs::CompressedImage& message, const std::string& name);

}  // namespace waretwin
