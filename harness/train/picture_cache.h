// Labelled pictures, decoded once and kept small.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "harness/labelled/labelled_set.h"
#include "harness/train/sample.h"

namespace waretwin::train {

// For several threads at once.
class PictureCache {
 public:
  // Pictures are stretched to `size`. Those that would take more than `bytes` in all are decoded again each time.
  PictureCache(const LabelledSet& set, const cv::Size& size, std::int64_t bytes);

  std::size_t count() const { return boxes_.size(); }
  // Throws Error for a file that is no picture. The picture is shared: nobody may write into it.
  Sample get(std::size_t index);

 private:
  cv::Size size_;
  std::int64_t free_bytes_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::vector<TruthBox>> boxes_;
  std::mutex mutex_;  // of the kept pictures
  std::vector<cv::Mat> kept_;
};

}  // namespace waretwin::train
