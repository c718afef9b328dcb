#include "sim/stereo_camera.h"

#include <vector>

#include "core/parallel.h"
#include "sim/infrared.h"

namespace waretwin {

namespace {

constexpr std::size_t kRowsAtOnce = 8;
// The ray from the right camera ends this share of its length before the surface, which would hide itself otherwise.
constexpr float kShort = 1e-4f;

// Light from the ceiling and what floor and walls throw back of it: a floor has all of it, a wall 60 %.
float ambient_light(const Eigen::Vector3f& normal_W) { return 0.6f + 0.4f * normal_W.z(); }

}  // namespace

StereoCamera::StereoCamera(std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces, const CameraConfig& camera)
    : ray_caster_(std::move(ray_caster)), surfaces_(surfaces), camera_(camera), intrinsics_(camera.depth_lens().intrinsics()) {}

StereoSignal StereoCamera::look(const Pose& X_WD, Stamp moment) const {
  const StereoConfig& config = camera_.stereo;
  const cv::Size size(intrinsics_.width, intrinsics_.height);
  StereoSignal signal;
  for (cv::Mat* image : {&signal.depth, &signal.ambient, &signal.dots}) *image = cv::Mat(size, CV_32FC1, cv::Scalar(0));
  signal.seen = cv::Mat(size, CV_8UC1, cv::Scalar(0));
  const Eigen::Vector3f left = X_WD.translation().cast<float>();
  const Eigen::Vector3f right = (X_WD * Eigen::Vector3d(config.baseline_m, 0.0, 0.0)).cast<float>();
  const Eigen::Matrix3f R = X_WD.linear().cast<float>();
  const float time = ray_caster_->time_of(moment);
  const auto spread = static_cast<float>(1.0 / config.focal_px);
  const auto scale = static_cast<float>(config.depth_times_disparity());
  parallel_for(static_cast<std::size_t>(size.height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto cols = static_cast<std::size_t>(size.width);
    std::vector<Ray> rays(cols), to_right;
    std::vector<Hit> hits(cols);
    std::vector<int> columns;
    std::vector<std::uint8_t> blocked;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (std::size_t x = 0; x < cols; ++x) {
        rays[x].time = time;
        rays[x].origin = left;
        // z is 1 in the camera's frame, so that distances are depths.
        rays[x].direction = R * intrinsics_.ray(static_cast<double>(x), y).cast<float>();
      }
      ray_caster_->cast(rays, hits, Coherence::kCoherent);
      to_right.clear();
      columns.clear();
      for (std::size_t x = 0; x < cols; ++x) {
        if (!hits[x].valid()) continue;
        const auto column = static_cast<int>(x);
        const SurfacePoint point = surfaces_.at(rays[x], hits[x], spread);
        const float z = hits[x].distance, length = rays[x].direction.norm(), range = z * length;
        const InfraredAnswer answer = infrared_answer(surfaces_.material(hits[x]), point, rays[x].direction / -length);
        signal.depth.at<float>(y, column) = z;
        signal.ambient.at<float>(y, column) = answer.albedo * ambient_light(point.normal);
        signal.dots.at<float>(y, column) = answer.backscatter / (range * range);
        if (!config.occlusion) signal.seen.at<std::uint8_t>(y, column) = 1;
        if (!config.occlusion || static_cast<float>(x) - scale / z < -0.5f) continue;
        Ray ray;
        ray.time = time;
        ray.origin = right;
        ray.direction = point.position - right;
        ray.far = 1.0f - kShort;
        to_right.push_back(ray);
        columns.push_back(column);
      }
      blocked.resize(to_right.size());
      ray_caster_->occluded(to_right, blocked, Coherence::kCoherent);
      for (std::size_t i = 0; i < columns.size(); ++i) signal.seen.at<std::uint8_t>(y, columns[i]) = blocked[i] ? 0 : 1;
    }
  });
  return signal;
}

}  // namespace waretwin
