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

// The detection whose box, as its mask, holds the segment; -1 = background.
int detection_of(const std::vector<int>& pixels, int width, const std::vector<Detection>& detections, const GeometricConfig& config) {
  int best = -1;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    const cv::Rect2f& box = detections[k].box;
    if (best >= 0 && box.area() >= detections[static_cast<std::size_t>(best)].box.area()) continue;
    const auto inside = std::count_if(pixels.begin(), pixels.end(), [&](int pixel) {
      return box.contains(cv::Point2f(static_cast<float>(pixel % width) + 0.5f, static_cast<float>(pixel / width) + 0.5f));
    });
    const bool held = static_cast<double>(inside) >= config.box_share * static_cast<double>(pixels.size());
    if (held && static_cast<double>(inside) >= config.min_box_fill * box.area()) best = static_cast<int>(k);
  }
  return best;
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

  Segmentation result;
  std::set<int> found;
  for (SegmentedObject& object : objects) {
    object.detection_index = detection_of(object.pixels, intrinsics.width, detections, geometric_);
    if (object.detection_index >= 0) {
      object.detection = detections[static_cast<std::size_t>(object.detection_index)];
      found.insert(object.detection_index);
    }
    result.objects.push_back(std::move(object));
  }
  const auto missed = static_cast<int>(detections.size() - found.size());
  if (missed > 0) result.rejected["no segment in the box"] = missed;
  return result;
}

}  // namespace waretwin
