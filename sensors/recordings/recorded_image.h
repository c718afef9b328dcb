// Pictures of recordings.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace waretwin {

// A colour picture as CV_8UC3, BGR. Throws Error for a missing or damaged file.
cv::Mat read_colour_image(const std::filesystem::path& file);

// A depth image of 16-bit units as CV_32FC1 in whole millimetres given in metres, 0 = invalid; `units_per_metre` as in RecordingConfig.
// 0 and 65535 are invalid. Throws Error for a missing or damaged file and for other than 16 bits and one channel.
cv::Mat read_depth_image(const std::filesystem::path& file, double units_per_metre);

// The other way, without loss. Colour (CV_8UC3, BGR) is compressed for speed: a drive has thousands of pictures. Depth (CV_32FC1, metres)
// is written in millimetres, that is 1000 units a metre. Both throw Error where the file cannot be written.
void write_colour_image(const std::filesystem::path& file, const cv::Mat& colour);
void write_depth_image(const std::filesystem::path& file, const cv::Mat& depth);

}  // namespace waretwin
