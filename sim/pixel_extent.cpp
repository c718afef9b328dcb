#include "sim/pixel_extent.h"

#include "core/error.h"

namespace waretwin {

std::map<int, PixelExtent> extents_of(const cv::Mat& ids) {
  WARETWIN_CHECK(ids.type() == CV_16UC1, "an image of ids");
  std::map<int, PixelExtent> extents;
  for (int v = 0; v < ids.rows; ++v) {
    const auto* row = ids.ptr<std::uint16_t>(v);
    for (int u = 0; u < ids.cols;) {
      int end = u + 1;
      while (end < ids.cols && row[end] == row[u]) ++end;
      if (row[u] != 0) extents[row[u]].add(cv::Rect(u, v, end - u, 1));
      u = end;
    }
  }
  return extents;
}

}  // namespace waretwin
