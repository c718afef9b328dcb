#include "sensors/measurements.h"

#include <cmath>
#include <utility>

#include "core/error.h"

namespace waretwin {

void load_pictures(RgbdFrame& frame) {
  if (!frame.load) return;
  const auto load = std::move(frame.load);
  frame.load = nullptr;
  load(frame);
  WARETWIN_CHECK(!frame.colour.empty() && frame.colour.size() == frame.depth.size(), "a loaded frame has colour and depth of one size");
}

cv::Mat depth_from_millimetres(const cv::Mat& millimetres) {
  WARETWIN_CHECK(millimetres.type() == CV_16UC1, "millimetres come as 16-bit integers");
  cv::Mat metres(millimetres.size(), CV_32FC1);
  for (int v = 0; v < millimetres.rows; ++v) {
    const auto* in = millimetres.ptr<std::uint16_t>(v);
    auto* out = metres.ptr<float>(v);
    for (int u = 0; u < millimetres.cols; ++u) out[u] = static_cast<float>(in[u]) * 0.001f;
  }
  return metres;
}

cv::Mat depth_to_millimetres(const cv::Mat& metres) {
  WARETWIN_CHECK(metres.type() == CV_32FC1, "metres come as 32-bit floats");
  cv::Mat millimetres(metres.size(), CV_16UC1);
  for (int v = 0; v < metres.rows; ++v) {
    const auto* in = metres.ptr<float>(v);
    auto* out = millimetres.ptr<std::uint16_t>(v);
    for (int u = 0; u < metres.cols; ++u) {
      const float mm = std::nearbyint(in[u] * 1000.0f);
      out[u] = mm > 0.0f && mm <= 65535.0f ? static_cast<std::uint16_t>(mm) : 0;
    }
  }
  return millimetres;
}

}  // namespace waretwin
