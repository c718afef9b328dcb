#include "harness/truth/truth_detector.h"

#include <limits>
#include <map>

#include "core/error.h"
#include "sim/pixel_extent.h"

namespace waretwin {

namespace {

// Area in pixels of the box around the whole cuboid as projected, also beyond the picture; infinite where a corner is behind the camera.
double projected_area(const Cuboid& cuboid, const Intrinsics& intrinsics, const Pose& X_WC) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner_W : cuboid.corners()) {
    const Eigen::Vector3d corner_C = X_WC.inverse() * corner_W;
    if (corner_C.z() <= 0.05) return std::numeric_limits<double>::infinity();
    box.extend(intrinsics.project(corner_C));
  }
  return box.volume();
}

}  // namespace

void TruthDetectorConfig::visit(Fields& f) {
  f("min_pixels", min_pixels, "objects with fewer pixels in the picture get no box", {.min = 1, .max = 1e9});
  f("min_depth_pixels", min_depth_pixels, "objects with fewer pixels that have depth get no box", {.min = 0, .max = 1e9});
  f("min_visible_share", min_visible_share,
    "visible box's area over the area of the whole object's box, parts beyond the picture included; below: no box", {.min = 0, .max = 1});
  f("masks", masks, "each box comes with its object's visible pixels, which profile voxbloxpp takes in the box's place");
}

std::vector<Detection> boxes_from_instances(const cv::Mat& instances, const cv::Mat& depth, const std::vector<TrueObject>& objects,
                                            const Intrinsics& intrinsics, const Pose& X_WC, const TruthDetectorConfig& config) {
  WARETWIN_CHECK(instances.type() == CV_16UC1 && depth.type() == CV_32FC1 && instances.size() == depth.size(), "images of one frame");
  const std::map<int, PixelExtent> extents = extents_of(instances);
  cv::Mat seen = instances.clone();
  seen.setTo(0, depth <= 0.0f);
  std::map<int, PixelExtent> with_depth = extents_of(seen);
  std::vector<Detection> detections;
  for (const TrueObject& object : objects) {
    const auto found = extents.find(object.id);
    if (found == extents.end()) continue;
    const PixelExtent& extent = found->second;
    if (extent.pixels < config.min_pixels || with_depth[object.id].pixels < config.min_depth_pixels) continue;
    const cv::Rect2f box = extent.box();
    if (static_cast<double>(box.area()) < config.min_visible_share * projected_area(object.cuboid, intrinsics, X_WC)) continue;
    Detection& detection = detections.emplace_back(Detection{object.class_name, box, 1.0f});
    if (config.masks) detection.mask = {instances.size(), run_lengths(instances(box) == object.id, box, instances.size())};
  }
  return detections;
}

std::vector<Detection> TruthDetector::detect(const RgbdFrame& frame) {
  const FrameTruth& truth = stream_.last_frame_truth();
  WARETWIN_CHECK(truth.stamp == frame.stamp && truth.sensor == frame.sensor, "the truth detector is asked for the stream's newest frame");
  return boxes_from_instances(truth.instances, frame.depth, stream_.scene().objects, stream_.info().cameras.at(frame.sensor).intrinsics,
                              truth.X_WC, config_);
}

}  // namespace waretwin
