#include "harness/train/picture_cache.h"

#include <opencv2/imgproc.hpp>

#include "mapper/detect/resized_picture.h"
#include "sensors/recordings/recorded_image.h"

namespace waretwin::train {

PictureCache::PictureCache(const LabelledSet& set, const cv::Size& size, std::int64_t bytes) : size_(size), free_bytes_(bytes) {
  for (const LabelledImage& image : set.images) {
    files_.push_back(image.file);
    std::vector<TruthBox>& boxes = boxes_.emplace_back();
    for (const LabelledBox& box : image.boxes) boxes.push_back({box.class_index, cv::Rect2f(box.share), box.ignored});
  }
  kept_.resize(files_.size());
}

Sample PictureCache::get(std::size_t index) {
  {
    const std::lock_guard lock(mutex_);
    if (!kept_[index].empty()) return {kept_[index], boxes_[index]};
  }
  cv::Mat small(size_, CV_8UC3);
  resize_picture(read_colour_image(files_[index]), small);
  cv::cvtColor(small, small, cv::COLOR_BGR2RGB);
  const auto bytes = static_cast<std::int64_t>(small.total() * small.elemSize());
  const std::lock_guard lock(mutex_);
  if (kept_[index].empty() && bytes <= free_bytes_) {
    free_bytes_ -= bytes;
    kept_[index] = small;
  }
  return {small, boxes_[index]};
}

}  // namespace waretwin::train
