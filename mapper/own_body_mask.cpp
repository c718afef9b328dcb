#include "mapper/own_body_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

void mask_image(cv::Mat& depth, const cv::Mat& stretches) {
  if (depth.empty()) return;
  WARETWIN_CHECK(depth.size() == stretches.size(), "the stream's pictures have the size that it names");
  // The source may hold on to its picture.
  depth = depth.clone();
  parallel_for(static_cast<std::size_t>(depth.rows), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      auto* row = depth.ptr<float>(static_cast<int>(v));
      const auto* stretch = stretches.ptr<cv::Vec2f>(static_cast<int>(v));
      for (int u = 0; u < depth.cols; ++u) {
        if (row[u] >= stretch[u][0] && row[u] <= stretch[u][1]) row[u] = 0.0f;
      }
    }
  });
}

}  // namespace

OwnBodyMask::OwnBodyMask(const StreamInfo& info) : box_B_(info.own_body_B) {
  if (!box_B_) return;
  for (const auto& [name, camera] : info.cameras) {
    registered_[name] = stretches(Lens(camera.intrinsics), camera.X_BC, *box_B_);
    if (camera.native) native_[name] = stretches(camera.native->lens, camera.X_BC * camera.native->X_CD, *box_B_);
  }
  for (const auto& [name, laser] : info.lasers) X_BL_[name] = laser.X_BL;
}

cv::Mat OwnBodyMask::stretches(const Lens& lens, const Pose& X_BC, const Eigen::AlignedBox3d& box) {
  const Intrinsics& size = lens.intrinsics();
  cv::Mat image(size.height, size.width, CV_32FC2, cv::Scalar::all(0));
  for (int v = 0; v < image.rows; ++v) {
    auto* row = image.ptr<cv::Vec2f>(v);
    for (int u = 0; u < image.cols; ++u) {
      const auto ray_C = lens.ray(u, v);
      if (!ray_C) continue;
      const Eigen::Vector3d ray = X_BC.linear() * *ray_C;
      // Between the nearest of the far walls and the farthest of the near ones.
      double near = 0.0, far = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min()[axis] - X_BC.translation()[axis]) / ray[axis],
                     b = (box.max()[axis] - X_BC.translation()[axis]) / ray[axis];
        if (std::isnan(a) || std::isnan(b)) continue;  // within a wall's plane
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
      }
      if (near < far && std::isfinite(far)) row[u] = {static_cast<float>(near), static_cast<float>(far)};
    }
  }
  return image;
}

void OwnBodyMask::mask(RgbdFrame& frame) const {
  if (!box_B_) return;
  const auto registered = registered_.find(frame.sensor);
  if (registered == registered_.end()) throw Error("no camera '" + frame.sensor + "'");
  mask_image(frame.depth, registered->second);
  const auto native = native_.find(frame.sensor);
  if (native != native_.end()) mask_image(frame.native_depth, native->second);
}

void OwnBodyMask::mask(LaserScan& scan) const {
  if (!box_B_) return;
  const auto laser = X_BL_.find(scan.sensor);
  if (laser == X_BL_.end()) return;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = static_cast<double>(scan.ranges[i]);
    if (!(range > 0.0)) continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    if (box_B_->contains(laser->second * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0.0))) scan.ranges[i] = 0.0f;
  }
}

}  // namespace waretwin
