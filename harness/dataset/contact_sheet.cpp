#include "harness/dataset/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "harness/pictures/rasteriser.h"

namespace waretwin {

namespace {

constexpr int kAcross = 6, kWidth = 320, kGap = 4;

}  // namespace

cv::Mat contact_sheet(const std::filesystem::path& folder, const std::vector<ImageRecord>& images,
                      const std::vector<std::string>& classes) {
  WARETWIN_CHECK(!images.empty(), "a sheet of something");
  const Intrinsics& first = images.front().intrinsics;
  const int height = std::max(1, kWidth * first.height / first.width);
  const int rows = (static_cast<int>(images.size()) + kAcross - 1) / kAcross;
  cv::Mat sheet(rows * (height + kGap) + kGap, kAcross * (kWidth + kGap) + kGap, CV_8UC3, cv::Scalar::all(40));
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::filesystem::path file = folder / "images" / (images[i].name + ".jpg");
    const cv::Mat picture = cv::imread(file.string(), cv::IMREAD_COLOR);
    if (picture.empty()) throw Error(file, "is gone or no picture; delete the folder and make the set again");
    const cv::Rect place(kGap + static_cast<int>(i % kAcross) * (kWidth + kGap), kGap + static_cast<int>(i / kAcross) * (height + kGap),
                         kWidth, height);
    cv::Mat thumbnail = sheet(place);
    cv::resize(picture, thumbnail, place.size(), 0, 0, cv::INTER_AREA);
    const double sx = static_cast<double>(kWidth) / picture.cols, sy = static_cast<double>(height) / picture.rows;
    const auto scaled = [&](const cv::Rect& box) {
      const cv::Point low(static_cast<int>(std::lround(box.x * sx)), static_cast<int>(std::lround(box.y * sy)));
      const cv::Point high(static_cast<int>(std::lround(box.br().x * sx)) - 1, static_cast<int>(std::lround(box.br().y * sy)) - 1);
      return cv::Rect(low, high + cv::Point(1, 1));
    };
    for (const ImageLabel& label : images[i].labels.labels) {
      const cv::Scalar colour = colour_of_id(label.class_index + 1);
      const cv::Rect amodal = scaled(label.amodal_box) & cv::Rect(-1, -1, kWidth + 2, height + 2);
      if (!amodal.empty()) cv::rectangle(thumbnail, amodal, 0.6 * colour, 1);
      const cv::Rect box = scaled(label.box);
      cv::rectangle(thumbnail, box, colour, 2);
      char text[96];
      std::snprintf(text, sizeof text, "%s %.0f%%", classes[static_cast<std::size_t>(label.class_index)].c_str(), 100.0 * label.visible);
      draw_text(thumbnail, {std::clamp(box.x + 3, 0, kWidth - 90), std::clamp(box.y + 13, 12, height - 3)}, text, colour, 0.38);
    }
  }
  return sheet;
}

}  // namespace waretwin
