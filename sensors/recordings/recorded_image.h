// Pictures of recordings.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace waretwin {

// PNG, JPEG or TIFF. `name` stands in errors.
cv::Mat decode_colour(std::string_view bytes, const std::string& name);  // CV_8UC3, BGR
// CV_16UC1 or CV_32FC1, as it is stored.
cv::Mat decode_depth(std::string_view bytes, const std::string& name);

// The same from files. Throw Error for a missing or damaged file, and for depth of another kind.
cv::Mat read_colour_image(const std::filesystem::path& file);
cv::Mat read_depth_image(const std::filesystem::path& file);

// How a depth image's numbers become metres.
struct DepthUnits {
  double per_metre = 1000.0;    // of 16-bit images; those of 32-bit floats are metres
  std::vector<double> invalid;  // units that mean "nothing measured", beside 0 and 65535
};

// Depth as stored -> CV_32FC1 in whole millimetres given in metres, 0 = invalid; so is what is not finite, below 0 or beyond 65.535 m.
cv::Mat depth_in_metres(const cv::Mat& stored, const DepthUnits& units);

// The other way, without loss. Colour (CV_8UC3, BGR) is compressed for speed: a drive has thousands of pictures. Depth (CV_32FC1, metres)
// is written in millimetres, that is 1000 units a metre. Both throw Error where the file cannot be written.
void write_colour_image(const std::filesystem::path& file, const cv::Mat& colour);
void write_depth_image(const std::filesystem::path& file, const cv::Mat& depth);

// What these write: PNG.
std::string encoded_png(const cv::Mat& image);

}  // namespace waretwin
