#include "mapper/segment/paper_segmenter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "mapper/segment/clusters.h"
#include "mapper/segment/cuboid_search.h"
#include "mapper/segment/hsv_histogram.h"
#include "mapper/segment/planes.h"

namespace waretwin {
namespace {

constexpr double kSupportSamples = 20000;  // pixels looked at for the support of one object

// Whole pixels whose centres lie in the box; pixel u covers [u, u + 1) of a detection's coordinates.
cv::Rect pixels_in(const cv::Rect2f& box, const Intrinsics& intrinsics) {
  const auto first = [](float edge) { return static_cast<int>(std::ceil(edge - 0.5f)); };
  const cv::Rect rect(cv::Point(first(box.x), first(box.y)), cv::Point(first(box.x + box.width), first(box.y + box.height)));
  return rect & cv::Rect(0, 0, intrinsics.width, intrinsics.height);
}

cv::Rect2f grown(const cv::Rect2f& box, double share) {
  const auto dx = static_cast<float>(share * box.width), dy = static_cast<float>(share * box.height);
  return {box.x - dx, box.y - dy, box.width + 2 * dx, box.height + 2 * dy};
}

}  // namespace

struct PaperSegmenter::Context {
  const RgbdFrame& frame;
  const Intrinsics& intrinsics;
  const Pose& X_WC;
  double depth_min, depth_max;
  Eigen::Vector3d up_W;

  float depth(int u, int v) const {
    const float z = frame.depth.at<float>(v, u);
    return z > depth_min && z <= depth_max ? z : 0.0f;
  }
  Eigen::Vector3d point_W(int u, int v, float z) const { return X_WC * (z * intrinsics.ray(u, v)); }
  double height(const Eigen::Vector3d& p_W) const { return up_W.dot(p_W); }
};

PaperSegmenter::PaperSegmenter(const SegmentConfig& config, const StreamInfo& info)
    : config_(config), cameras_(info.cameras), up_W_(info.up_W.normalized()) {}

Segmentation PaperSegmenter::segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                                     const Pose& X_WC) {
  WARETWIN_CHECK(frame.depth.cols == intrinsics.width && frame.depth.rows == intrinsics.height, "depth and intrinsics are of one size");
  Segmentation result;
  if (detections.empty()) return result;
  Context context{frame, intrinsics, X_WC, config_.depth_min_m, config_.depth_max_m, up_W_};
  const auto camera = cameras_.find(frame.sensor);
  if (camera != cameras_.end()) {
    if (context.depth_min <= 0.0) context.depth_min = camera->second.depth_min_m;
    if (context.depth_max <= 0.0) context.depth_max = camera->second.depth_max_m;
  }
  if (context.depth_max <= 0.0) context.depth_max = std::numeric_limits<double>::infinity();
  const Levels levels = find_levels(context);

  // Section 4.2: what is cut out first is gone for the boxes that follow.
  const auto rank = [&](const Detection& detection) {
    return std::find(config_.cut_first.begin(), config_.cut_first.end(), detection.class_name) - config_.cut_first.begin();
  };
  std::vector<const Detection*> order;
  for (const Detection& detection : detections) order.push_back(&detection);
  std::stable_sort(order.begin(), order.end(), [&](const Detection* a, const Detection* b) { return rank(*a) < rank(*b); });
  std::vector<char> taken(static_cast<std::size_t>(intrinsics.width) * intrinsics.height, 0);
  for (const Detection* detection : order) {
    SegmentedObject object;
    object.detection = *detection;
    const std::string reason = segment_one(context, levels, taken, object);
    if (!reason.empty()) {
      ++result.rejected[reason];
      continue;
    }
    if (rank(*detection) < static_cast<std::ptrdiff_t>(config_.cut_first.size())) {
      for (const int pixel : object.pixels) taken[pixel] = 1;
    }
    result.objects.push_back(std::move(object));
  }
  return result;
}

PaperSegmenter::Levels PaperSegmenter::find_levels(const Context& context) const {
  Levels levels;
  const PlaneConfig& config = config_.planes;
  const Eigen::Vector3d up_C = context.X_WC.linear().transpose() * up_W_;
  const double least_cosine = std::cos(to_radians(config.level_angle_deg));
  for (const DetectedPlane& plane : detect_planes(context.frame.depth, context.intrinsics, context.depth_min, context.depth_max, config)) {
    if (plane.normal_C.dot(up_C) >= least_cosine) levels.horizontal.push_back(context.height(context.X_WC * plane.centroid_C));
  }
  levels.ground = config.ground_height_m;
  levels.ground_clearance = config.clearance_max_m;
  bool seen = false;
  for (const double height : levels.horizontal) {
    if (config.ground == "lowest_plane") {
      if (!seen || height < levels.ground) levels.ground = height;
      seen = true;
    } else if (std::abs(height - config.ground_height_m) <= config.ground_tolerance_m) {
      levels.ground = height;  // largest first
      seen = true;
      break;
    }
  }
  if (!seen) {
    // A world whose floor is unknown and out of sight has no ground to remove.
    if (config.ground == "lowest_plane") levels.ground = -std::numeric_limits<double>::infinity();
    return levels;
  }
  std::vector<HeightSample> samples;
  for (int v = 0; v < context.intrinsics.height; v += config.stride) {
    for (int u = 0; u < context.intrinsics.width; u += config.stride) {
      const float z = context.depth(u, v);
      if (z <= 0.0f) continue;
      const double height = context.height(context.point_W(u, v, z));
      if (std::abs(height - levels.ground) <= config.ground_tolerance_m) samples.push_back({0, 0, static_cast<float>(height), false});
    }
  }
  const SupportPlane ground = refine_level(samples, levels.ground, config.ground_tolerance_m, false);
  levels.ground = ground.height;
  levels.ground_clearance = std::clamp(3.0 * ground.sigma, config.clearance_min_m, config.clearance_max_m);
  return levels;
}

std::optional<SupportPlane> PaperSegmenter::support_of(const Context& context, const cv::Rect2f& box, const Levels& levels) const {
  const cv::Rect inner = pixels_in(box, context.intrinsics);
  const cv::Rect outer = pixels_in(grown(box, config_.planes.support_ring), context.intrinsics);
  // Boxes of real detectors are a few pixels off: what lies at their very edge says nothing about inside and outside.
  const cv::Rect edge = pixels_in(grown(box, 0.03), context.intrinsics);
  const int step = std::max(1, static_cast<int>(std::sqrt(outer.area() / kSupportSamples)));
  std::vector<HeightSample> samples;
  for (int v = outer.y; v < outer.br().y; v += step) {
    for (int u = outer.x; u < outer.br().x; u += step) {
      const bool in_box = inner.contains({u, v});
      if (!in_box && edge.contains({u, v})) continue;
      const float z = context.depth(u, v);
      if (z <= 0.0f) continue;
      samples.push_back(
          {static_cast<float>(u), static_cast<float>(v), static_cast<float>(context.height(context.point_W(u, v, z))), in_box});
    }
  }
  const double ground = std::isfinite(levels.ground) ? levels.ground : config_.planes.ground_height_m;
  return find_support(samples, levels.horizontal, ground, config_.planes);
}

std::string PaperSegmenter::segment_one(const Context& context, const Levels& levels, const std::vector<char>& taken,
                                        SegmentedObject& object) const {
  const cv::Rect2f box = grown(object.detection.box, config_.box_margin);
  const cv::Rect rect = pixels_in(box, context.intrinsics);
  double floor = levels.ground, clearance = levels.ground_clearance;
  if (config_.planes.remove == "support") {
    if (const auto support = support_of(context, object.detection.box, levels)) {
      floor = support->height;
      clearance = std::clamp(3.0 * support->sigma, config_.planes.clearance_min_m, config_.planes.clearance_max_m);
    }
  }

  // Pixels above the plane, and those so near to it that they may be its own.
  std::vector<int> pixels, foot_pixels;
  std::vector<Eigen::Vector3f> points_W, foot_points_W;
  int with_depth = 0;
  for (int v = rect.y; v < rect.br().y; ++v) {
    for (int u = rect.x; u < rect.br().x; ++u) {
      const int pixel = v * context.intrinsics.width + u;
      const float z = context.depth(u, v);
      if (z <= 0.0f || taken[pixel]) continue;
      ++with_depth;
      const Eigen::Vector3d p_W = context.point_W(u, v, z);
      const double above = context.height(p_W) - floor;
      if (above > clearance) {
        pixels.push_back(pixel);
        points_W.push_back(p_W.cast<float>());
      } else if (above >= 0.0) {
        foot_pixels.push_back(pixel);
        foot_points_W.push_back(p_W.cast<float>());
      }
    }
  }
  if (with_depth < config_.min_pixels) return "no depth";
  if (static_cast<int>(pixels.size()) < config_.min_pixels) return "only ground or support";

  const ClusterResult cluster = select_cluster(points_W, config_);
  if (!cluster.rejected.empty()) return cluster.rejected;
  if (static_cast<int>(cluster.kept.size()) < config_.min_pixels) return "too few points";
  std::vector<std::pair<int, Eigen::Vector3f>> kept;
  kept.reserve(cluster.kept.size());
  for (const int i : cluster.kept) {
    kept.emplace_back(pixels[i], points_W[i]);
    object.points_W.push_back(points_W[i]);
  }
  const double step = to_radians(config_.heading_step_deg);
  object.cuboid = search_cuboid(object.points_W, step);
  if (config_.recover_foot) {
    // The plane itself cannot be seen inside the object's rectangle: what is seen there is the object's lower rim.
    const Pose X_OW = object.cuboid.pose().inverse();
    for (std::size_t i = 0; i < foot_pixels.size(); ++i) {
      const Eigen::Vector3d p_O = X_OW * foot_points_W[i].cast<double>();
      if (std::abs(p_O.x()) <= 0.5 * object.cuboid.size.x() && std::abs(p_O.y()) <= 0.5 * object.cuboid.size.y()) {
        kept.emplace_back(foot_pixels[i], foot_points_W[i]);
      }
    }
    std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  }
  object.points_W.clear();
  for (const auto& [pixel, p_W] : kept) {
    object.pixels.push_back(pixel);
    object.points_W.push_back(p_W);
  }
  object.cuboid = search_cuboid(object.points_W, step);
  object.hsv = hsv_histogram(context.frame.colour, object.detection.box);
  return "";
}

}  // namespace waretwin
