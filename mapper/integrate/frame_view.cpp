#include "mapper/integrate/frame_view.h"

#include "core/error.h"

namespace waretwin {

void check_frame(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels) {
  const auto pixels = static_cast<std::size_t>(intrinsics.width) * static_cast<std::size_t>(intrinsics.height);
  WARETWIN_CHECK(frame.depth.type() == CV_32FC1 && frame.colour.type() == CV_8UC3, "frame of another type");
  WARETWIN_CHECK(frame.depth.cols == intrinsics.width && frame.depth.rows == intrinsics.height && frame.colour.size() == frame.depth.size(),
                 "frame of another size than its intrinsics");
  WARETWIN_CHECK(labels.empty() || labels.size() == pixels, "one label per pixel");
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> viewing_box(const Intrinsics& intrinsics, const Pose& X_WC, double depth) {
  Eigen::Vector3d low = X_WC.translation(), high = low;
  for (const double u : {-0.5, intrinsics.width - 0.5}) {
    for (const double v : {-0.5, intrinsics.height - 0.5}) {
      const Eigen::Vector3d corner = X_WC * (intrinsics.ray(u, v) * depth);
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  return {low, high};
}

}  // namespace waretwin
