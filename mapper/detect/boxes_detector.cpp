#include "mapper/detect/boxes_detector.h"

#include <cstdlib>
#include <iterator>
#include <string>

#include "core/error.h"

namespace waretwin {

namespace {

constexpr Stamp kTolerance = 1'000'000;

std::string size_text(const cv::Size& size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

}  // namespace

BoxesDetector::BoxesDetector(const std::filesystem::path& path, const DetectConfig& config)
    : path_(path), frames_(read_boxes(path, config)) {}

std::vector<Detection> BoxesDetector::detect(const RgbdFrame& frame) {
  const Stamp stamp = frame.named_stamp.value_or(frame.stamp);
  auto nearest = frames_.lower_bound(stamp);
  if (nearest != frames_.begin()) {
    const auto before = std::prev(nearest);
    if (nearest == frames_.end() || stamp - before->first <= nearest->first - stamp) nearest = before;
  }
  std::vector<Detection> detections;
  if (nearest == frames_.end() || std::abs(nearest->first - stamp) > kTolerance) return detections;
  const cv::Mat& picture = frame.colour.empty() ? frame.depth : frame.colour;
  const cv::Rect2f whole(0.0f, 0.0f, static_cast<float>(picture.cols), static_cast<float>(picture.rows));
  for (Detection detection : nearest->second) {
    if (!detection.mask.empty() && detection.mask.size != picture.size()) {
      throw Error(path_, "a mask of " + size_text(detection.mask.size) + " pixels in a frame of " + size_text(picture.size()) +
                             "; expected masks of the whole picture");
    }
    detection.box &= whole;
    if (detection.box.width > 0.0f && detection.box.height > 0.0f) detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace waretwin
