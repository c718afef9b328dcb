#include "sensors/recordings/bag_pictures.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "core/error.h"
#include "sensors/recordings/recorded_image.h"

namespace waretwin {

namespace {

struct Encoding {
  int type = 0;     // as OpenCV says it
  int to_bgr = -1;  // cv::cvtColor's code; -1: it is BGR
  bool depth = false;
};

const std::map<std::string, Encoding>& encodings() {
  static const std::map<std::string, Encoding> known = {
      {"bgr8", {CV_8UC3, -1}},
      {"8UC3", {CV_8UC3, -1}},
      {"rgb8", {CV_8UC3, cv::COLOR_RGB2BGR}},
      {"bgra8", {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {"8UC4", {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {"rgba8", {CV_8UC4, cv::COLOR_RGBA2BGR}},
      {"mono8", {CV_8UC1, cv::COLOR_GRAY2BGR}},
      {"8UC1", {CV_8UC1, cv::COLOR_GRAY2BGR}},
      {"16UC1", {CV_16UC1, -1, true}},
      {"mono16", {CV_16UC1, -1, true}},
      {"32FC1", {CV_32FC1, -1, true}},
  };
  return known;
}

// The message's pixels in this machine's byte order.
cv::Mat pixels_of(const sensor_msgs::Image& message, const Encoding& encoding, const std::string& name) {
  constexpr std::uint32_t kMostPixels = 32768;
  const std::size_t pixel = CV_ELEM_SIZE(encoding.type);
  const std::size_t row = pixel * message.width;
  if (message.width == 0 || message.height == 0 || message.width > kMostPixels || message.height > kMostPixels || message.step < row ||
      message.data.size() < static_cast<std::size_t>(message.step) * message.height) {
    throw Error(name + ": is damaged: " + std::to_string(message.width) + " x " + std::to_string(message.height) + " pixels of " +
                message.encoding + " in " + std::to_string(message.data.size()) + " bytes, " + std::to_string(message.step) + " a row");
  }
  cv::Mat pixels(static_cast<int>(message.height), static_cast<int>(message.width), encoding.type);
  for (std::uint32_t v = 0; v < message.height; ++v) {
    std::memcpy(pixels.ptr(static_cast<int>(v)), message.data.data() + static_cast<std::size_t>(v) * message.step, row);
  }
  const std::size_t number = CV_ELEM_SIZE1(encoding.type);
  if (number > 1 && message.is_bigendian != 0) {  // all machines that this is built for are little-endian
    auto* bytes = pixels.ptr();
    for (std::size_t i = 0; i < pixels.total() * number; i += number) std::reverse(bytes + i, bytes + i + number);
  }
  return pixels;
}

std::string_view bytes_of(const sensor_msgs::CompressedImage& message, std::size_t from = 0) {
  return {reinterpret_cast<const char*>(message.data.data()) + from, message.data.size() - from};
}

}  // namespace

bool is_depth_encoding(const std::string& encoding) {
  const auto found = encodings().find(encoding);
  return found != encodings().end() && found->second.depth;
}

bool is_colour_encoding(const std::string& encoding) {
  const auto found = encodings().find(encoding);
  return found != encodings().end() && !found->second.depth;
}

cv::Mat colour_of(const sensor_msgs::Image& message, const std::string& name) {
  if (!is_colour_encoding(message.encoding)) {
    throw Error(name + ": has encoding '" + message.encoding + "'; expected bgr8, rgb8, bgra8, rgba8, mono8, 8UC1, 8UC3 or 8UC4");
  }
  const Encoding& encoding = encodings().at(message.encoding);
  const cv::Mat pixels = pixels_of(message, encoding, name);
  if (encoding.to_bgr < 0) return pixels;
  cv::Mat bgr;
  cv::cvtColor(pixels, bgr, encoding.to_bgr);
  return bgr;
}

cv::Mat colour_of(const sensor_msgs::CompressedImage& message, const std::string& name) { return decode_colour(bytes_of(message), name); }

cv::Mat depth_of(const sensor_msgs::Image& message, const std::string& name) {
  if (!is_depth_encoding(message.encoding)) {
    throw Error(name + ": has encoding '" + message.encoding + "'; expected 16UC1, mono16 or 32FC1");
  }
  return pixels_of(message, encodings().at(message.encoding), name);
}

cv::Mat depth_of(const sensor_msgs::CompressedImage& message, const std::string& name) {
  if (message.format.find("compressedDepth") == std::string::npos) return decode_depth(bytes_of(message), name);
  // compressed_depth_image_transport: an enumeration and two floats, then a PNG of 16 bits. Of floats it holds the quantised inverse depth
  // q, and depth = a / (q - b).
  constexpr std::size_t kHeader = 12;
  if (message.data.size() <= kHeader)
    throw Error(name + ": is damaged: " + std::to_string(message.data.size()) + " bytes of compressedDepth");
  float a = 0.0f, b = 0.0f;
  std::memcpy(&a, message.data.data() + 4, sizeof a);
  std::memcpy(&b, message.data.data() + 8, sizeof b);
  const cv::Mat stored = decode_depth(bytes_of(message, kHeader), name);
  if (message.format.rfind("32FC1", 0) != 0) return stored;
  if (stored.type() != CV_16UC1) throw Error(name + ": is damaged: compressedDepth of floats holds a PNG of other than 16 bits");
  cv::Mat metres(stored.size(), CV_32FC1);
  for (int v = 0; v < stored.rows; ++v) {
    for (int u = 0; u < stored.cols; ++u) {
      const std::uint16_t q = stored.at<std::uint16_t>(v, u);
      metres.at<float>(v, u) = q == 0 ? 0.0f : a / (static_cast<float>(q) - b);
    }
  }
  return metres;
}

}  // namespace waretwin
