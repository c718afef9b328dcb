#include "harness/pictures/png_file.h"

#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {

void write_png(const std::filesystem::path& file, const cv::Mat& image) {
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", image, png)) throw InternalError("a picture could not be encoded: " + file.string());
  write_file(file, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

}  // namespace waretwin
