#include "sim/colour_camera.h"

#include <algorithm>
#include <memory>

#include "sim/motion_blur.h"

namespace waretwin {

ColourCamera::ColourCamera(const CameraConfig& camera, std::uint64_t seed, const std::string& sensor, Renderer& renderer)
    : camera_(camera),
      seed_(seed),
      sensor_(sensor),
      renderer_(renderer),
      lens_(camera.colour_lens()),
      bent_(!lens_.distortion().is_none()) {
  if (camera.colour.is_ideal()) return;
  model_.emplace(camera, seed, sensor);
  if (bent_ && camera.colour.rectify) rectification_.emplace(lens_, camera.intrinsics());
}

Stamp ColourCamera::half_span() const {
  return -row_delay(0) + (camera_.colour.motion_blur ? from_seconds(0.5 * camera_.colour.exposure_s) : 0);
}

Stamp ColourCamera::row_delay(int v) const {
  if (!camera_.colour.rolling_shutter) return 0;
  return from_seconds(camera_.colour.readout_s * (v - 0.5 * (camera_.height - 1)) / std::max(camera_.height - 1, 1));
}

std::vector<PixelRays::Row> ColourCamera::rows(Stamp stamp, const std::function<Pose(Stamp)>& X_WC) const {
  const Stamp half = camera_.colour.motion_blur ? from_seconds(0.5 * camera_.colour.exposure_s) : 0;
  const RayCaster& caster = renderer_.ray_caster();
  std::vector<PixelRays::Row> out(static_cast<std::size_t>(camera_.height));
  for (std::size_t v = 0; v < out.size(); ++v) {
    const Stamp middle = stamp + row_delay(static_cast<int>(v));
    out[v].X_WC = X_WC(middle);
    out[v].X_WC_begin = half > 0 ? X_WC(middle - half) : out[v].X_WC;
    out[v].X_WC_end = half > 0 ? X_WC(middle + half) : out[v].X_WC;
    out[v].begin = caster.time_of(middle - half);
    out[v].middle = caster.time_of(middle);
    out[v].end = caster.time_of(middle + half);
  }
  return out;
}

PictureRays ColourCamera::picture_rays(Stamp stamp, const std::function<Pose(Stamp)>& X_WC) const {
  if (!model_) return pinhole_rays(camera_.intrinsics(), X_WC(stamp), Ray().time);
  PictureRays out = pinhole_rays(camera_.view().intrinsics(), X_WC(stamp), renderer_.ray_caster().time_of(stamp));
  const auto taken = std::make_shared<const PixelRays>(model_->rays(), 1.0 / lens_.intrinsics().fx, rows(stamp, X_WC));
  const Rectification* rectification = rectification_ ? &*rectification_ : nullptr;
  out.at = [beyond = out.at, taken, rectification, width = camera_.width, height = camera_.height](int u, int v) {
    if (u < 0 || v < 0 || u >= width || v >= height) return beyond(u, v);
    if (rectification == nullptr) return taken->at(u, v);
    const cv::Point at = rectification->nearest(u, v);
    return taken->at(at.x, at.y);
  };
  return out;
}

FrameImages ColourCamera::look(Stamp stamp, const std::function<Pose(Stamp)>& X_WC, bool colour, bool classes, bool depth) {
  RenderRequest request;
  request.colour = colour;
  request.classes = classes;
  request.seed = seed_;
  request.sensor = sensor_;
  request.stamp = stamp;
  const Pose X_WC_now = X_WC(stamp);
  if (!model_) return renderer_.render(camera_.intrinsics(), X_WC_now, request);

  request.colour = false;
  request.radiance = colour;
  const std::vector<PixelRays::Row> taken = rows(stamp, X_WC);
  const PixelRays rays(model_->rays(), 1.0 / lens_.intrinsics().fx, taken);
  FrameImages images = renderer_.render(rays, request);
  if (colour) {
    const bool moves =
        std::any_of(taken.begin(), taken.end(), [](const PixelRays::Row& row) { return row.X_WC_begin.matrix() != row.X_WC_end.matrix(); });
    if (moves && renderer_.options().quality == "fast") {
      const double row_time =
          camera_.colour.rolling_shutter ? camera_.colour.readout_s / (camera_.height - 1) / camera_.colour.exposure_s : 0.0;
      images.radiance = motion_blurred(images.radiance, images.depth, model_->rays(), taken, row_time);
    }
    images.colour = model_->picture(images.radiance, stamp);
    images.radiance.release();
  }
  if (rectification_) {
    if (colour) images.colour = rectification_->colour(images.colour);
    images.instances = rectification_->labels(images.instances);
    if (classes) images.classes = rectification_->labels(images.classes);
  }

  if (!depth) {
    images.depth.release();
    return images;
  }
  const float time_now = renderer_.ray_caster().time_of(stamp);
  const bool at_once = std::all_of(taken.begin(), taken.end(), [&](const PixelRays::Row& row) {
    return row.X_WC.matrix() == X_WC_now.matrix() && row.middle == time_now;
  });
  if (!at_once || rectification_) {
    RenderRequest geometry = request;
    geometry.radiance = geometry.classes = false;
    if (camera_.colour.rectify || !bent_) {
      images.depth = renderer_.render(camera_.intrinsics(), X_WC_now, geometry).depth;
    } else {
      const PixelRays::Row row = {X_WC_now, X_WC_now, X_WC_now, time_now, time_now, time_now};
      const PixelRays now(model_->rays(), 1.0 / lens_.intrinsics().fx, std::vector<PixelRays::Row>(taken.size(), row));
      images.depth = renderer_.render(now, geometry).depth;
    }
  }
  return images;
}

}  // namespace waretwin
