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

// The picture's pixels that a detection calls its object's.
class Region {
 public:
  Region(const Detection& detection, const cv::Size& picture) : box_(detection.box) {
    if (detection.mask.empty()) return;
    WARETWIN_CHECK(detection.mask.size == picture, "a mask is one of the whole picture");
    mask_ = mask_picture(detection.mask);
  }
  bool is_mask() const { return !mask_.empty(); }
  double area() const { return box_.area(); }
  bool holds(int u, int v) const {
    if (is_mask()) return mask_.at<std::uint8_t>(v, u) != 0;
    return box_.contains(cv::Point2f(static_cast<float>(u) + 0.5f, static_cast<float>(v) + 0.5f));
  }

 private:
  cv::Rect2f box_;
  cv::Mat mask_;  // empty: the box is all that is known
};

// The detection that holds the segment: the mask with most of its pixels, else the smallest box; -1 = background.
int detection_of(const std::vector<int>& pixels, int width, const std::vector<Region>& regions, const GeometricConfig& config) {
  int best = -1;
  bool by_mask = false;
  double rank = 0.0;  // the higher one wins
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const Region& region = regions[k];
    const auto inside = static_cast<double>(
        std::count_if(pixels.begin(), pixels.end(), [&](int pixel) { return region.holds(pixel % width, pixel / width); }));
    if (inside < config.box_share * static_cast<double>(pixels.size())) continue;
    if (!region.is_mask() && inside < config.min_box_fill * region.area()) continue;
    const double its_rank = region.is_mask() ? inside : -region.area();
    if (best >= 0 && (by_mask != region.is_mask() ? by_mask : its_rank <= rank)) continue;
    best = static_cast<int>(k);
    by_mask = region.is_mask();
    rank = its_rank;
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

  std::vector<Region> regions;
  for (const Detection& detection : detections) regions.emplace_back(detection, frame.depth.size());
  Segmentation result;
  std::set<int> found;
  for (SegmentedObject& object : objects) {
    object.detection_index = detection_of(object.pixels, intrinsics.width, regions, geometric_);
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
