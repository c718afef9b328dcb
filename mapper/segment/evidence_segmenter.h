// Object segmentation of profile best: no decision in a single frame, but what each ray in and around a box tells.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapper/segment/depth_rays.h"
#include "mapper/segment/evidence_rays_config.h"
#include "mapper/segment/segment_config.h"
#include "mapper/segment/segmenter.h"
#include "mapper/segment/support_plane.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// Rays that end inside the box and above what the object stands on speak for the object, rays that end elsewhere for something else; near
// the box's edge and close above the support they tell only what they pass. Frames taken in fast rotation tell nothing. Where boxes
// overlap, a ray in both is unknown to both; but a box within another one has its rays for itself, and of a table's box (cut_first) only
// the level top is the table's.
class EvidenceSegmenter : public Segmenter {
 public:
  EvidenceSegmenter(const SegmentConfig& config, const EvidenceRaysConfig& rays, const StreamInfo& info);

  // As PaperSegmenter::segment; SegmentedObject::pixels are those of the colour view inside the box and above the support (clutter in the
  // box among them); `cuboid` and `hsv` stay empty. Reasons: "no depth", "only ground or support", "camera turns too fast",
  // "second box on an object" (nearly the same box of the same class stands before it).
  Segmentation segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                       const Pose& X_WC) override;

 private:
  // A detection in this frame.
  struct Box {
    const Detection* detection = nullptr;
    cv::Rect2f inner, outer, region;                        // surely the object's, perhaps the object's, looked at
    double floor = 0.0;                                     // metres: height of what it stands on
    bool on_support = false;                                // not the ground
    float clearance = 0.0f;                                 // metres above it that may be its own
    double top = std::numeric_limits<double>::quiet_NaN();  // metres: of a class that is cut out first
  };

  SupportPlane ground_of(const DepthPoints& points);
  Box look_at(const DepthPoints& points, const Detection& detection, const SupportPlane& ground) const;
  double top_of(const DepthPoints& points, const Box& box) const;
  RayKind contested(const Box& mine, const std::vector<Box>& boxes, const Eigen::Vector2f& pixel, float z) const;
  int collect_rays(const DepthPoints& points, const Box& box, const std::vector<Box>& boxes, std::vector<EvidenceRay>& rays) const;
  void collect_pixels(const RgbdFrame& frame, const Intrinsics& intrinsics, const Pose& X_WC, const Box& box,
                      std::pair<double, double> depth_range, SegmentedObject& object) const;
  std::optional<SupportPlane> support_of(const DepthPoints& points, const cv::Rect2f& box, double ground) const;
  bool turns_too_fast(const RgbdFrame& frame, const Pose& X_WC);

  SegmentConfig config_;
  EvidenceRaysConfig rays_config_;
  std::map<std::string, StreamInfo::Camera> cameras_;
  DepthRays depth_rays_;
  // Unknown until it is seen, where the world's zero is not the floor: everything is then above it.
  SupportPlane last_ground_{-std::numeric_limits<double>::infinity(), 0.0};
  struct Last {
    Stamp stamp;
    Eigen::Quaterniond q_WC;
  };
  std::map<std::string, Last> last_;
};

}  // namespace waretwin
