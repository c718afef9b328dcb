#include "mapper/segment/geometric_segmenter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/error.h"

namespace waretwin {
namespace {

// The label of each pixel of the whole picture: that of the thinned pixel around it whose depth is nearest, 0 where none is near.
std::vector<std::int32_t> spread(const ConvexSegments& segments, const cv::Mat& depth, int thin, double share) {
  std::vector<std::int32_t> labels(depth.total(), 0);
  std::size_t i = 0;
  for (int v = 0; v < depth.rows; ++v) {
    const auto* row = depth.ptr<float>(v);
    for (int u = 0; u < depth.cols; ++u, ++i) {
      const float z = row[u];
      if (!(z > 0.0f)) continue;
      auto nearest = static_cast<float>(thin * share * z);
      for (const int y : {v / thin, (v + thin - 1) / thin}) {
        for (const int x : {u / thin, (u + thin - 1) / thin}) {
          if (x >= segments.width || y >= segments.height) continue;
          const std::int32_t label = segments.labels[static_cast<std::size_t>(y) * static_cast<std::size_t>(segments.width) + x];
          const float distance = std::abs(depth.at<float>(y * thin, x * thin) - z);
          if (label == 0 || !(distance < nearest)) continue;
          nearest = distance;
          labels[i] = label;
        }
      }
    }
  }
  return labels;
}

// Visits the picture's pixels that a detection calls its object's, as v * width + u: those of its mask, else those with their centre in its
// box.
template <class Visit>
void visit_pixels(const Detection& detection, int width, int height, Visit&& visit) {
  if (!detection.mask.empty()) {
    WARETWIN_CHECK(detection.mask.size == cv::Size(width, height), "a mask is one of the whole picture");
    int at = 0;  // column by column
    bool inside = false;
    for (const int run : detection.mask.runs) {
      for (int k = inside ? at : at + run; k < at + run; ++k) visit(k % height * width + k / height);
      at += run;
      inside = !inside;
    }
    return;
  }
  const cv::Rect2f& box = detection.box;
  const auto first = [](float edge, int last) { return std::clamp(static_cast<int>(std::ceil(edge - 0.5f)), 0, last); };
  for (int v = first(box.y, height); v < first(box.y + box.height, height); ++v) {
    for (int u = first(box.x, width); u < first(box.x + box.width, width); ++u) visit(v * width + u);
  }
}

// The detection that each segment is part of: the mask with most of its pixels, else the smallest box; -1 = background. `labels` by pixel,
// `sizes` by label.
std::vector<int> match_detections(const std::vector<std::int32_t>& labels, const std::vector<int>& sizes, int width,
                                  const std::vector<Detection>& detections, const GeometricConfig& config) {
  struct Held {
    int detection = -1;
    bool by_mask = false;
    double rank = 0.0;  // the higher one holds it
  };
  std::vector<Held> held(sizes.size());
  std::vector<int> inside(sizes.size());
  for (std::size_t k = 0; k < detections.size(); ++k) {
    std::fill(inside.begin(), inside.end(), 0);
    visit_pixels(detections[k], width, static_cast<int>(labels.size()) / width,
                 [&](int pixel) { ++inside[static_cast<std::size_t>(labels[static_cast<std::size_t>(pixel)])]; });
    const bool is_mask = !detections[k].mask.empty();
    const double area = detections[k].box.area();
    for (std::size_t label = 1; label < sizes.size(); ++label) {
      if (inside[label] == 0 || inside[label] < config.box_share * sizes[label]) continue;
      if (!is_mask && inside[label] < config.min_box_fill * area) continue;
      const double rank = is_mask ? inside[label] : -area;
      Held& holder = held[label];
      if (holder.detection >= 0 && (holder.by_mask != is_mask ? holder.by_mask : rank <= holder.rank)) continue;
      holder = {static_cast<int>(k), is_mask, rank};
    }
  }
  std::vector<int> matched;
  for (const Held& holder : held) matched.push_back(holder.detection);
  return matched;
}

}  // namespace

GeometricSegmenter::GeometricSegmenter(const SegmentConfig& config, const GeometricConfig& geometric, const StreamInfo& info)
    : config_(config), geometric_(geometric), cameras_(info.cameras) {}

Segmentation GeometricSegmenter::segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                                         const Pose& X_WC) {
  WARETWIN_CHECK(frame.depth.cols == intrinsics.width && frame.depth.rows == intrinsics.height, "depth and intrinsics are of one size");
  double depth_min = config_.depth_min_m, depth_max = config_.depth_max_m;
  const auto camera = cameras_.find(frame.sensor);
  if (camera != cameras_.end()) {
    if (depth_min <= 0.0) depth_min = camera->second.depth_min_m;
    if (depth_max <= 0.0) depth_max = camera->second.depth_max_m;
  }
  if (depth_max <= 0.0) depth_max = std::numeric_limits<double>::infinity();

  const ConvexSegments segments = find_convex_segments(frame.depth, intrinsics, depth_min, depth_max, geometric_);
  const std::vector<std::int32_t> labels = spread(segments, frame.depth, geometric_.thin, geometric_.discontinuity_share);
  std::vector<SegmentedObject> objects(static_cast<std::size_t>(segments.count));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0) continue;
    SegmentedObject& object = objects[static_cast<std::size_t>(labels[i] - 1)];
    const int u = static_cast<int>(i) % intrinsics.width, v = static_cast<int>(i) / intrinsics.width;
    object.pixels.push_back(static_cast<int>(i));
    object.points_W.push_back((X_WC * (static_cast<double>(frame.depth.at<float>(v, u)) * intrinsics.ray(u, v))).cast<float>());
  }

  std::vector<int> sizes(objects.size() + 1);
  for (std::size_t i = 0; i < objects.size(); ++i) sizes[i + 1] = static_cast<int>(objects[i].pixels.size());
  const std::vector<int> matched = match_detections(labels, sizes, intrinsics.width, detections, geometric_);

  Segmentation result;
  std::set<int> found;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    SegmentedObject& object = objects[i];
    object.detection_index = matched[i + 1];
    if (object.detection_index >= 0) {
      const Detection& detection = detections[static_cast<std::size_t>(object.detection_index)];
      object.detection = {detection.class_name, detection.box, detection.score};
      found.insert(object.detection_index);
    }
    result.objects.push_back(std::move(object));
  }
  const auto missed = static_cast<int>(detections.size() - found.size());
  if (missed > 0) result.rejected["no segment in the box"] = missed;
  return result;
}

}  // namespace waretwin
