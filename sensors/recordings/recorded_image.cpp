#include "sensors/recordings/recorded_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "core/files.h"
#include "sensors/measurements.h"

namespace waretwin {

namespace {

constexpr std::uintmax_t kLargest = std::uintmax_t{256} << 20;

cv::Mat decode(std::string_view bytes, const std::string& name, int flags) {
  cv::Mat image;
  if (!bytes.empty()) {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    try {
      image = cv::imdecode(raw, flags);
    } catch (const cv::Exception&) {
      image.release();
    }
  }
  if (image.empty()) throw Error(name + ": is not a picture that can be decoded; expected PNG or JPEG");
  return image;
}

}  // namespace

cv::Mat decode_colour(std::string_view bytes, const std::string& name) {
  return decode(bytes, name, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
}

cv::Mat decode_depth(std::string_view bytes, const std::string& name) {
  cv::Mat stored = decode(bytes, name, cv::IMREAD_UNCHANGED);
  if (stored.type() != CV_16UC1 && stored.type() != CV_32FC1) {
    throw Error(name + ": has " + std::to_string(8 * stored.elemSize1()) + " bits and " + std::to_string(stored.channels()) +
                " channels; expected a depth image of 16 bits (or of 32-bit floats in metres) and one channel");
  }
  return stored;
}

cv::Mat read_colour_image(const std::filesystem::path& file) { return decode_colour(read_file(file, kLargest), file.string()); }

cv::Mat read_depth_image(const std::filesystem::path& file) { return decode_depth(read_file(file, kLargest), file.string()); }

cv::Mat depth_in_metres(const cv::Mat& stored, const DepthUnits& units) {
  WARETWIN_CHECK(stored.type() == CV_16UC1 || stored.type() == CV_32FC1, "depth as it is stored");
  const bool metres = stored.type() == CV_32FC1;
  const double millimetres_per_unit = metres ? 1000.0 : 1000.0 / units.per_metre;
  const auto is_invalid = [&](double unit) {
    return !(unit > 0.0) || (!metres && unit == 65535.0) ||
           std::find(units.invalid.begin(), units.invalid.end(), unit) != units.invalid.end();
  };
  cv::Mat whole(stored.size(), CV_16UC1);
  for (int v = 0; v < stored.rows; ++v) {
    auto* row = whole.ptr<std::uint16_t>(v);
    for (int u = 0; u < stored.cols; ++u) {
      const double unit = metres ? static_cast<double>(stored.ptr<float>(v)[u]) : static_cast<double>(stored.ptr<std::uint16_t>(v)[u]);
      const double millimetres = is_invalid(unit) ? 0.0 : std::nearbyint(unit * millimetres_per_unit);
      row[u] = millimetres <= 65535.0 ? static_cast<std::uint16_t>(millimetres) : 0;
    }
  }
  return depth_from_millimetres(whole);
}

std::string encoded_png(const cv::Mat& image) {
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", image, png, {cv::IMWRITE_PNG_COMPRESSION, 1})) throw InternalError("a picture could not be encoded");
  return {png.begin(), png.end()};
}

void write_colour_image(const std::filesystem::path& file, const cv::Mat& colour) {
  WARETWIN_CHECK(colour.type() == CV_8UC3, "colour has three channels of 8 bits");
  write_file(file, encoded_png(colour));
}

void write_depth_image(const std::filesystem::path& file, const cv::Mat& depth) {
  WARETWIN_CHECK(depth.type() == CV_32FC1, "depth is an image of 32-bit floats");
  write_file(file, encoded_png(depth_to_millimetres(depth)));
}

}  // namespace waretwin
