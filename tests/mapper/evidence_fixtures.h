// Traced frames through the segmenter and associator of profile best.
#pragma once

#include <numbers>
#include <vector>

#include "core/pose.h"
#include "mapper/associate/evidence_associator.h"
#include "mapper/segment/evidence_segmenter.h"
#include "tests/mapper/traced_frame.h"

namespace waretwin::test {

class EvidenceMapping {
 public:
  explicit EvidenceMapping(const EvidenceConfig& config = {}) : associator_(config) {}

  // Detections of the boxes with these numbers, as they are seen from X_WC.
  std::vector<int> look(const TracedScene& scene, const Pose& X_WC, const std::vector<int>& detected, double sigma = 0.0) {
    TracedFrame traced = trace(scene, intrinsics_, X_WC, sigma, static_cast<std::uint64_t>(frame_));
    std::vector<Detection> detections;
    for (const int i : detected) {
      if (traced.boxes[static_cast<std::size_t>(i)]) detections.push_back({"conveyor", *traced.boxes[static_cast<std::size_t>(i)], 1.0f});
    }
    return take(std::move(traced.frame), X_WC, detections);
  }

  std::vector<int> take(RgbdFrame frame, const Pose& X_WC, const std::vector<Detection>& detections) {
    frame.stamp = ++frame_ * 1'000'000'000LL;
    const Segmentation segmentation = segmenter_.segment(frame, intrinsics_, detections, X_WC);
    rejected = segmentation.rejected;
    AssociationContext context;
    context.frame_id = frame_;
    context.stamp = frame.stamp;
    context.X_WC = X_WC;
    context.intrinsics = intrinsics_;
    context.depth = frame.depth;
    return associator_.associate(segmentation.objects, context, map);
  }

  const ObjectList& finish() {
    associator_.finish(map, TsdfVolume(TsdfConfig{}));
    return map;
  }
  std::vector<std::pair<int, int>> take_merges() { return associator_.take_merges(); }
  const Intrinsics& intrinsics() const { return intrinsics_; }

  ObjectList map;
  std::map<std::string, int> rejected;

 private:
  Intrinsics intrinsics_ = kinect(640, 360);
  EvidenceSegmenter segmenter_{SegmentConfig{}, EvidenceRaysConfig{.max_turn_deg_s = 1e4}, kinect_stream(intrinsics_)};
  EvidenceAssociator associator_;
  int frame_ = 0;
};

// Places 1 m before a station at the origin, from which the paper's camera looks at (x, y) from `degrees` off the front (-y).
inline Pose from_the_front(double degrees, double distance = 1.0, double x = 0.0, double y = 0.0) {
  const double a = to_radians(degrees);
  return camera_pose(x + distance * std::sin(a), y - distance * std::cos(a), 1.4, std::numbers::pi / 2 + a, to_radians(45));
}

inline std::vector<Pose> a_drive_past() {
  std::vector<Pose> poses;
  for (const double degrees : {-55.0, -35.0, -20.0, 0.0, 15.0, 30.0, 45.0, 60.0}) poses.push_back(from_the_front(degrees, 0.95));
  return poses;
}

}  // namespace waretwin::test
