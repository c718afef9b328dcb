#include "sensors/recordings/recorded_image.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "sensors/measurements.h"

namespace waretwin {

namespace {

cv::Mat decode(const std::filesystem::path& file, int flags) {
  constexpr std::uintmax_t kLargest = std::uintmax_t{256} << 20;
  const std::string bytes = read_file(file, kLargest);
  cv::Mat image;
  if (!bytes.empty()) {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    try {
      image = cv::imdecode(raw, flags);
    } catch (const cv::Exception&) {
      image.release();
    }
  }
  if (image.empty()) throw Error(file, "is not a picture that can be decoded; expected PNG or JPEG");
  return image;
}

void encode(const std::filesystem::path& file, const cv::Mat& image) {
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", image, png, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    throw InternalError("a picture could not be encoded: " + file.string());
  }
  write_file(file, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

}  // namespace

cv::Mat read_colour_image(const std::filesystem::path& file) { return decode(file, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION); }

cv::Mat read_depth_image(const std::filesystem::path& file, double units_per_metre) {
  cv::Mat units = decode(file, cv::IMREAD_UNCHANGED);
  if (units.type() != CV_16UC1) {
    throw Error(file, "has " + std::to_string(8 * units.elemSize1()) + " bits and " + std::to_string(units.channels()) +
                          " channels; expected a depth image of 16 bits and one channel");
  }
  const double millimetres_per_unit = 1000.0 / units_per_metre;
  for (int v = 0; v < units.rows; ++v) {
    auto* row = units.ptr<std::uint16_t>(v);
    for (int u = 0; u < units.cols; ++u) {
      const double millimetres = row[u] == 65535 ? 0.0 : std::nearbyint(row[u] * millimetres_per_unit);
      row[u] = millimetres <= 65535.0 ? static_cast<std::uint16_t>(millimetres) : 0;
    }
  }
  return depth_from_millimetres(units);
}

void write_colour_image(const std::filesystem::path& file, const cv::Mat& colour) {
  WARETWIN_CHECK(colour.type() == CV_8UC3, "colour has three channels of 8 bits");
  encode(file, colour);
}

void write_depth_image(const std::filesystem::path& file, const cv::Mat& depth) {
  WARETWIN_CHECK(depth.type() == CV_32FC1, "depth is an image of 32-bit floats");
  encode(file, depth_to_millimetres(depth));
}

}  // namespace waretwin
