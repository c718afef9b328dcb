#include "harness/score/depth_quality.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace waretwin {

namespace {

double share(std::int64_t part, std::int64_t whole) { return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0; }

}  // namespace

void DepthQualityMeter::add(const cv::Mat& sensor, const cv::Mat& ideal, const cv::Mat& instances, const cv::Mat& field, double near_m,
                            double far_m) {
  WARETWIN_CHECK(sensor.size() == ideal.size() && sensor.size() == instances.size() && sensor.size() == field.size(),
                 "one size of all images");
  constexpr float kBreak = 0.04f, kBetween = 0.01f;
  const cv::Mat window = cv::Mat::ones(5, 5, CV_8UC1);
  cv::Mat nearest, farthest, lowest_id, highest_id;
  cv::erode(ideal, nearest, window);
  cv::dilate(ideal, farthest, window);
  cv::erode(instances, lowest_id, window);
  cv::dilate(instances, highest_id, window);
  const auto low = static_cast<float>(near_m), high = static_cast<float>(far_m);
  for (int v = 0; v < ideal.rows; ++v) {
    for (int u = 0; u < ideal.cols; ++u) {
      const float truth = ideal.at<float>(v, u), reading = sensor.at<float>(v, u);
      if (field.at<std::uint8_t>(v, u) == 0 || !(truth >= low && truth <= high)) continue;
      const bool is_object = instances.at<std::uint16_t>(v, u) != 0, is_valid = reading > 0.0f;
      ++pixels_;
      valid_ += is_valid;
      object_pixels_ += is_object;
      object_missing_ += is_object && !is_valid;
      if (!is_valid) continue;
      const auto error_mm = static_cast<std::size_t>(std::lround(std::min(1.0f, std::abs(reading - truth)) * 1000.0f));
      ++errors_mm_[error_mm];
      const float first = nearest.at<float>(v, u), last = farthest.at<float>(v, u);
      if (first == 0.0f || last - first <= kBreak || lowest_id.at<std::uint16_t>(v, u) == highest_id.at<std::uint16_t>(v, u)) continue;
      ++edge_readings_;
      flying_ += reading > first + kBetween && reading < last - kBetween && std::abs(reading - truth) > kBetween;
    }
  }
}

DepthQuality DepthQualityMeter::result() const {
  DepthQuality quality;
  quality.valid_share = share(valid_, pixels_);
  quality.object_missing_share = share(object_missing_, object_pixels_);
  quality.flying_share = share(flying_, edge_readings_);
  const auto quantile = [this](double q) {
    std::int64_t below = 0;
    for (std::size_t mm = 0; mm < errors_mm_.size(); ++mm) {
      below += errors_mm_[mm];
      if (valid_ > 0 && static_cast<double>(below) >= q * static_cast<double>(valid_)) return 0.001 * static_cast<double>(mm);
    }
    return 0.0;
  };
  quality.median_abs_error_m = quantile(0.5);
  quality.p95_abs_error_m = quantile(0.95);
  return quality;
}

}  // namespace waretwin
