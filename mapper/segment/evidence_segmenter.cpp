#include "mapper/segment/evidence_segmenter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "mapper/associate/similarity.h"

namespace waretwin {
namespace {

constexpr double kSupportSamples = 8000;  // pixels looked at for the support of one object

bool inside(const cv::Rect2f& box, const Eigen::Vector2f& pixel) {
  return pixel.x() >= box.x && pixel.y() >= box.y && pixel.x() < box.x + box.width && pixel.y() < box.y + box.height;
}

cv::Rect2f grown(const cv::Rect2f& box, float by) { return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by}; }

cv::Rect2f grown(const cv::Rect2f& box, double share, double least_px) {
  const float dx = static_cast<float>(std::max(share * box.width, least_px)),
              dy = static_cast<float>(std::max(share * box.height, least_px));
  return {box.x - dx, box.y - dy, box.width + 2 * dx, box.height + 2 * dy};
}

}  // namespace

EvidenceSegmenter::EvidenceSegmenter(const SegmentConfig& config, const EvidenceRaysConfig& rays, const StreamInfo& info)
    : config_(config), rays_config_(rays), cameras_(info.cameras), depth_rays_(info, rays.thin) {}

bool EvidenceSegmenter::turns_too_fast(const RgbdFrame& frame, const Pose& X_WC) {
  const Eigen::Quaterniond q(X_WC.linear());
  const auto before = last_.find(frame.sensor);
  bool fast = false;
  if (before != last_.end() && frame.stamp > before->second.stamp) {
    const double seconds = to_seconds(frame.stamp - before->second.stamp);
    fast = q.angularDistance(before->second.q_WC) / seconds > to_radians(rays_config_.max_turn_deg_s);
  }
  last_[frame.sensor] = {frame.stamp, q};
  return fast;
}

Segmentation EvidenceSegmenter::segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                                        const Pose& X_WC) {
  Segmentation result;
  const bool fast = turns_too_fast(frame, X_WC);
  if (detections.empty()) return result;
  if (fast) {
    result.rejected["camera turns too fast"] += static_cast<int>(detections.size());
    return result;
  }
  double depth_min = config_.depth_min_m, depth_max = config_.depth_max_m;
  const auto camera = cameras_.find(frame.sensor);
  if (camera != cameras_.end()) {
    if (depth_min <= 0.0) depth_min = camera->second.depth_min_m;
    if (depth_max <= 0.0) depth_max = camera->second.depth_max_m;
  }
  if (depth_max <= 0.0) depth_max = std::numeric_limits<double>::infinity();

  const DepthPoints points = depth_rays_.points(frame, X_WC, depth_min, depth_max);
  const double ground = ground_of(points);
  const Eigen::Matrix3f R_WC = X_WC.linear().cast<float>();
  const Eigen::Vector3f p_WC = X_WC.translation().cast<float>();
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const Detection& detection = detections[d];
    // Of boxes that are nearly the same one is enough.
    const auto same = [&](const Detection& other) {
      return other.class_name == detection.class_name && iou_2d(other.box, detection.box) > rays_config_.same_box_iou;
    };
    if (std::any_of(detections.begin(), detections.begin() + static_cast<std::ptrdiff_t>(d), same)) {
      ++result.rejected["second box on an object"];
      continue;
    }
    SegmentedObject object;
    object.detection = detection;
    const cv::Rect2f& box = detection.box;
    const auto support = support_of(points, box, ground);
    const double floor = support ? support->height : ground;
    const double sigma = support ? support->sigma : 0.0;
    const float clearance = static_cast<float>(std::clamp(3.0 * sigma, config_.planes.clearance_min_m, config_.planes.clearance_max_m));
    const auto slack =
        static_cast<float>(std::max<double>(rays_config_.box_slack_px, rays_config_.box_slack_share * std::max(box.width, box.height)));
    const cv::Rect2f inner = grown(box, -slack), outer = grown(box, slack);
    const cv::Rect2f region = grown(box, rays_config_.ring_share, rays_config_.ring_min_px);
    std::vector<const cv::Rect2f*> others;
    for (const Detection& other : detections) {
      if (&other != &detection && !same(other) && (grown(other.box, slack) & outer).area() > 0.0f) others.push_back(&other.box);
    }
    object.support_W = floor;
    object.rays_from_W = points.from_W;
    int with_depth = 0;
    for (std::size_t i = 0; i < points.depth.size(); ++i) {
      if (points.depth[i] == 0.0f || !inside(region, points.pixels[i])) continue;
      EvidenceRay ray{points.points_W[i], RayKind::other};
      const float above = ray.hit_W.z() - static_cast<float>(floor);
      if (inside(outer, points.pixels[i])) {
        ++with_depth;
        if (above > clearance) {
          ray.kind = inside(inner, points.pixels[i]) ? RayKind::object : RayKind::unknown;
          for (const cv::Rect2f* other : others) {
            if (inside(grown(*other, slack), points.pixels[i])) ray.kind = RayKind::unknown;
          }
        } else if (above > -clearance) {
          ray.kind = RayKind::unknown;
        }
      }
      object.rays.push_back(ray);
    }
    if (with_depth * rays_config_.thin * rays_config_.thin < config_.min_pixels) {
      ++result.rejected["no depth"];
      continue;
    }
    // The same decision for the pixels of the colour view, which carry the labels.
    const cv::Rect rect =
        cv::Rect(cv::Point(static_cast<int>(std::ceil(box.x - 0.5f)), static_cast<int>(std::ceil(box.y - 0.5f))),
                 cv::Point(static_cast<int>(std::ceil(box.x + box.width - 0.5f)), static_cast<int>(std::ceil(box.y + box.height - 0.5f)))) &
        cv::Rect(0, 0, intrinsics.width, intrinsics.height);
    const auto low = static_cast<float>(depth_min), high = static_cast<float>(std::min(depth_max, 1e6));
    const auto fx = static_cast<float>(1.0 / intrinsics.fx), fy = static_cast<float>(1.0 / intrinsics.fy);
    for (int v = rect.y; v < rect.br().y; ++v) {
      const auto* row = frame.depth.ptr<float>(v);
      const float y = (static_cast<float>(v) - static_cast<float>(intrinsics.cy)) * fy;
      for (int u = rect.x; u < rect.br().x; ++u) {
        const float z = row[u];
        if (!(z > low && z <= high)) continue;
        const Eigen::Vector3f p_W =
            R_WC * (z * Eigen::Vector3f((static_cast<float>(u) - static_cast<float>(intrinsics.cx)) * fx, y, 1.0f)) + p_WC;
        if (p_W.z() - static_cast<float>(floor) <= clearance) continue;
        object.pixels.push_back(v * intrinsics.width + u);
        object.points_W.push_back(p_W);
      }
    }
    if (static_cast<int>(object.pixels.size()) < config_.min_pixels) {
      ++result.rejected["only ground or support"];
      continue;
    }
    result.objects.push_back(std::move(object));
  }
  return result;
}

double EvidenceSegmenter::ground_of(const DepthPoints& points) const {
  const PlaneConfig& config = config_.planes;
  if (config.ground == "world_zero") return config.ground_height_m;
  // The lowest height at which much is level: a floor fills many pixels, what is seen through a hole in it does not.
  constexpr double kBin = 0.02;
  std::map<int, int> histogram;
  int total = 0;
  for (std::size_t i = 0; i < points.depth.size(); i += 7) {
    if (points.depth[i] == 0.0f) continue;
    ++histogram[static_cast<int>(std::floor(points.points_W[i].z() / kBin))];
    ++total;
  }
  for (const auto& [bin, count] : histogram) {
    if (count > 0.05 * total) return (bin + 0.5) * kBin;
  }
  return -std::numeric_limits<double>::infinity();
}

std::optional<SupportPlane> EvidenceSegmenter::support_of(const DepthPoints& points, const cv::Rect2f& box, double ground) const {
  const cv::Rect2f ring = grown(box, config_.planes.support_ring, 0.0);
  // Boxes of real detectors are a few pixels off: what lies at their very edge says nothing about inside and outside.
  const cv::Rect2f edge = grown(box, 0.03, 0.0);
  std::vector<HeightSample> samples;
  for (std::size_t i = 0; i < points.depth.size(); ++i) {
    if (points.depth[i] == 0.0f || !inside(ring, points.pixels[i])) continue;
    const bool in_box = inside(box, points.pixels[i]);
    if (!in_box && inside(edge, points.pixels[i])) continue;
    samples.push_back({points.pixels[i].x(), points.pixels[i].y(), points.points_W[i].z(), in_box});
  }
  const auto step = static_cast<std::size_t>(std::max(1.0, static_cast<double>(samples.size()) / kSupportSamples));
  if (step > 1) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples.size(); i += step) samples[kept++] = samples[i];
    samples.resize(kept);
  }
  return find_support(samples, {}, std::isfinite(ground) ? ground : config_.planes.ground_height_m, config_.planes);
}

}  // namespace waretwin
