#include "harness/pictures/picture_file.h"

#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {

std::string encoded(const cv::Mat& image, const std::string& ending, const std::vector<int>& parameters) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(ending, image, bytes, parameters)) throw InternalError("a picture could not be encoded as " + ending);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string encoded_jpeg(const cv::Mat& image, int quality) { return encoded(image, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality}); }

void write_png(const std::filesystem::path& file, const cv::Mat& image) { write_file(file, encoded(image, ".png")); }

}  // namespace waretwin
