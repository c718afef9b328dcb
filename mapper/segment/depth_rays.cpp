#include "mapper/segment/depth_rays.h"

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

DepthRays::DepthRays(const StreamInfo& info, int thin, bool native) : cameras_(info.cameras), thin_(thin), native_(native) {}

const DepthRays::View& DepthRays::view_of(const RgbdFrame& frame) {
  const StreamInfo::Camera& camera = cameras_.at(frame.sensor);
  const bool native = native_ && camera.native.has_value() && !frame.native_depth.empty();
  View& view = views_[{frame.sensor, native}];
  if (!view.rays_C.empty()) return view;
  view.native = native;
  view.colour = camera.intrinsics;
  const Lens lens = native ? camera.native->lens : Lens(camera.intrinsics);
  if (native) view.X_CD = camera.native->X_CD;
  view.width = (lens.intrinsics().width + thin_ - 1) / thin_;
  view.height = (lens.intrinsics().height + thin_ - 1) / thin_;
  const Eigen::Matrix3d R = view.X_CD.linear();
  view.rays_C.reserve(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  for (int v = 0; v < lens.intrinsics().height; v += thin_) {
    for (int u = 0; u < lens.intrinsics().width; u += thin_) {
      const auto ray = lens.ray(u, v);
      view.rays_C.push_back(ray ? Eigen::Vector3f((R * *ray).cast<float>()) : Eigen::Vector3f::Zero());
    }
  }
  return view;
}

DepthPoints DepthRays::points(const RgbdFrame& frame, const Pose& X_WC, double depth_min, double depth_max) {
  const View& view = view_of(frame);
  const cv::Mat& picture = view.native ? frame.native_depth : frame.depth;
  WARETWIN_CHECK((picture.cols + thin_ - 1) / thin_ == view.width && (picture.rows + thin_ - 1) / thin_ == view.height,
                 "depth of another size than its camera");
  DepthPoints result;
  result.width = view.width;
  result.height = view.height;
  result.from_W = X_WC * view.X_CD.translation();
  const std::size_t count = view.rays_C.size();
  result.depth.resize(count);
  result.points_W.resize(count);
  result.pixels.resize(count);
  const Eigen::Matrix3f R_WC = X_WC.linear().cast<float>();
  const Eigen::Vector3f p_WC = X_WC.translation().cast<float>(), p_CD = view.X_CD.translation().cast<float>();
  const auto fx = static_cast<float>(view.colour.fx), fy = static_cast<float>(view.colour.fy);
  const auto cx = static_cast<float>(view.colour.cx + 0.5), cy = static_cast<float>(view.colour.cy + 0.5);
  const auto low = static_cast<float>(depth_min), high = static_cast<float>(depth_max);
  parallel_for(static_cast<std::size_t>(view.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto* row = picture.ptr<float>(static_cast<int>(v) * thin_);
      std::size_t i = v * static_cast<std::size_t>(view.width);
      for (int u = 0; u < view.width; ++u, ++i) {
        const float measured = row[u * thin_];
        const Eigen::Vector3f& ray = view.rays_C[i];
        result.depth[i] = 0.0f;
        // A pixel that sees nothing lies outside every box.
        result.pixels[i] = Eigen::Vector2f::Constant(-1e6f);
        if (!(measured >= low && measured <= high && measured > 0.0f && std::isfinite(measured)) || ray.isZero(0.0f)) continue;
        const Eigen::Vector3f p_C = measured * ray + p_CD;
        if (!(p_C.z() > 1e-3f)) continue;
        result.depth[i] = measured;
        result.points_W[i] = R_WC * p_C + p_WC;
        result.pixels[i] = {fx * p_C.x() / p_C.z() + cx, fy * p_C.y() / p_C.z() + cy};
      }
    }
  });
  return result;
}

}  // namespace waretwin
