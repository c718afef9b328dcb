// Where the pixels of one id lie in a picture.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <opencv2/core/mat.hpp>

namespace waretwin {

struct PixelExtent {
  int low_u = std::numeric_limits<int>::max(), low_v = std::numeric_limits<int>::max();
  int high_u = std::numeric_limits<int>::min(), high_v = std::numeric_limits<int>::min();  // included
  std::int64_t pixels = 0;

  void add(int u, int v) { add(cv::Rect(u, v, 1, 1)); }
  // All pixels of a rectangle that is not empty.
  void add(const cv::Rect& rect) {
    low_u = std::min(low_u, rect.x);
    low_v = std::min(low_v, rect.y);
    high_u = std::max(high_u, rect.x + rect.width - 1);
    high_v = std::max(high_v, rect.y + rect.height - 1);
    pixels += rect.area();
  }
  void add(const PixelExtent& other) {
    low_u = std::min(low_u, other.low_u);
    low_v = std::min(low_v, other.low_v);
    high_u = std::max(high_u, other.high_u);
    high_v = std::max(high_v, other.high_v);
    pixels += other.pixels;
  }
  // The smallest box around the pixels, in whole pixels: x and y are the first column and row. Empty without pixels.
  cv::Rect box() const { return pixels == 0 ? cv::Rect() : cv::Rect(low_u, low_v, high_u - low_u + 1, high_v - low_v + 1); }
};

// By id; 0 is left out. `ids` CV_16UC1.
std::map<int, PixelExtent> extents_of(const cv::Mat& ids);

}  // namespace waretwin
