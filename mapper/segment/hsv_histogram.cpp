#include "mapper/segment/hsv_histogram.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace waretwin {
namespace {

constexpr int kHueBins = 12, kSaturationBins = 4, kValueBins = 4;

}  // namespace

std::vector<float> hsv_histogram(const cv::Mat& colour, const cv::Rect2f& box) {
  WARETWIN_CHECK(colour.empty() || colour.type() == CV_8UC3, "colour pictures are 8-bit BGR");
  std::vector<float> histogram(kHueBins * kSaturationBins * kValueBins, 0.0f);
  const cv::Point low(static_cast<int>(std::floor(box.x)), static_cast<int>(std::floor(box.y)));
  const cv::Point high(static_cast<int>(std::ceil(box.x + box.width)), static_cast<int>(std::ceil(box.y + box.height)));
  const cv::Rect crop = cv::Rect(low, high) & cv::Rect(0, 0, colour.cols, colour.rows);
  if (crop.empty()) return histogram;
  cv::Mat hsv;
  cv::cvtColor(colour(crop), hsv, cv::COLOR_BGR2HSV);  // hue in [0, 180)
  std::vector<int> counts(histogram.size(), 0);
  for (int v = 0; v < hsv.rows; ++v) {
    const auto* pixel = hsv.ptr<cv::Vec3b>(v);
    for (int u = 0; u < hsv.cols; ++u) {
      const int h = pixel[u][0] * kHueBins / 180, s = pixel[u][1] * kSaturationBins / 256, w = pixel[u][2] * kValueBins / 256;
      ++counts[(h * kSaturationBins + s) * kValueBins + w];
    }
  }
  for (std::size_t i = 0; i < counts.size(); ++i) histogram[i] = static_cast<float>(counts[i]) / static_cast<float>(crop.area());
  return histogram;
}

}  // namespace waretwin
