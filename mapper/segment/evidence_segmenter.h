// Object segmentation of profile best: no decision in a single frame, but what each ray in and around a box tells.
#pragma once

#include <map>
#include <optional>
#include <string>
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
// overlap, a ray in both is unknown to both.
class EvidenceSegmenter : public Segmenter {
 public:
  EvidenceSegmenter(const SegmentConfig& config, const EvidenceRaysConfig& rays, const StreamInfo& info);

  // As PaperSegmenter::segment; SegmentedObject::pixels are those of the colour view inside the box and above the support (clutter in the
  // box among them); `cuboid` and `hsv` stay empty. Reasons: "no depth", "only ground or support", "camera turns too fast",
  // "second box on an object" (nearly the same box of the same class stands before it).
  Segmentation segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                       const Pose& X_WC) override;

 private:
  double ground_of(const DepthPoints& points) const;
  std::optional<SupportPlane> support_of(const DepthPoints& points, const cv::Rect2f& box, double ground) const;
  bool turns_too_fast(const RgbdFrame& frame, const Pose& X_WC);

  SegmentConfig config_;
  EvidenceRaysConfig rays_config_;
  std::map<std::string, StreamInfo::Camera> cameras_;
  DepthRays depth_rays_;
  struct Last {
    Stamp stamp;
    Eigen::Quaterniond q_WC;
  };
  std::map<std::string, Last> last_;
};

}  // namespace waretwin
