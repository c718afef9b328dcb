#include "sensors/rectification.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

constexpr std::size_t kRowsAtOnce = 16;

}  // namespace

Rectification::Rectification(const Lens& lens, const Intrinsics& view)
    : width_(view.width), height_(view.height), taken_width_(lens.intrinsics().width), taken_height_(lens.intrinsics().height) {
  sources_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  parallel_for(static_cast<std::size_t>(height_), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (int u = 0; u < width_; ++u) {
        const auto pixel = lens.project(view.ray(u, static_cast<double>(v)));
        if (!pixel || !lens.intrinsics().contains(pixel->x(), pixel->y())) {
          throw Error("rectified pixel (" + std::to_string(u) + ", " + std::to_string(v) +
                      ") lies outside the colour lens's image; expected a distortion that grows from the middle to the corners");
        }
        const double x = std::clamp(pixel->x(), 0.0, taken_width_ - 1.0), y = std::clamp(pixel->y(), 0.0, taken_height_ - 1.0);
        const int left = std::min(static_cast<int>(x), taken_width_ - 2), top = std::min(static_cast<int>(y), taken_height_ - 2);
        sources_[v * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)] = {
            top * taken_width_ + left, static_cast<std::uint16_t>(std::lround(256.0 * (x - left))),
            static_cast<std::uint16_t>(std::lround(256.0 * (y - top)))};
      }
    }
  });
}

cv::Mat Rectification::colour(const cv::Mat& taken) const {
  WARETWIN_CHECK(taken.type() == CV_8UC3 && taken.isContinuous() && taken.cols == taken_width_ && taken.rows == taken_height_,
                 "a continuous colour picture of the lens's size");
  cv::Mat out(height_, width_, CV_8UC3);
  const auto* const pixels = taken.ptr<std::uint8_t>();
  const std::size_t below = 3 * static_cast<std::size_t>(taken_width_);
  parallel_for(static_cast<std::size_t>(height_), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Source* source = &sources_[v * static_cast<std::size_t>(width_)];
      auto* row = out.ptr<std::uint8_t>(static_cast<int>(v));
      for (int u = 0; u < width_; ++u, ++source, row += 3) {
        const std::uint8_t* p = pixels + 3 * static_cast<std::size_t>(source->first);
        const std::uint32_t fx = source->fx, fy = source->fy;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t top = p[c] * (256 - fx) + p[c + 3] * fx, low = p[below + c] * (256 - fx) + p[below + c + 3] * fx;
          row[c] = static_cast<std::uint8_t>((top * (256 - fy) + low * fy + 32768) >> 16);
        }
      }
    }
  });
  return out;
}

cv::Mat Rectification::labels(const cv::Mat& taken) const {
  WARETWIN_CHECK(taken.type() == CV_16UC1 && taken.isContinuous() && taken.cols == taken_width_ && taken.rows == taken_height_,
                 "a continuous label picture of the lens's size");
  cv::Mat out(height_, width_, CV_16UC1);
  const auto* const pixels = taken.ptr<std::uint16_t>();
  parallel_for(static_cast<std::size_t>(height_), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Source* source = &sources_[v * static_cast<std::size_t>(width_)];
      auto* row = out.ptr<std::uint16_t>(static_cast<int>(v));
      for (int u = 0; u < width_; ++u, ++source) row[u] = pixels[source->nearest(taken_width_)];
    }
  });
  return out;
}

cv::Point Rectification::nearest(int u, int v) const {
  const Source& source = sources_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
  const std::int32_t index = source.nearest(taken_width_);
  return {index % taken_width_, index / taken_width_};
}

}  // namespace waretwin
