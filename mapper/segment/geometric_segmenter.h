// Object segmentation of profile voxbloxpp: the whole frame in convex segments, some of which a box gives a class.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mapper/segment/convex_segments.h"
#include "mapper/segment/geometric_config.h"
#include "mapper/segment/segment_config.h"
#include "mapper/segment/segmenter.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// Grinvald et al. 2019, section III-B: a segment takes the detection whose mask holds at least box_share of its pixels, of several the one
// that holds most. Where detections have no masks, a box stands for one if the segment fills min_box_fill of it, of several the smallest
// box. What reaches farther out of all of them is background, and so are scraps. Nothing is removed as ground or support: floors and table
// tops are segments like others, and mostly larger than the boxes before them.
class GeometricSegmenter : public Segmenter {
 public:
  GeometricSegmenter(const SegmentConfig& config, const GeometricConfig& geometric, const StreamInfo& info);

  // All segments of the frame, background too, in the order of their first pixels: those of no detection have an empty class name and
  // detection_index -1. `cuboid` and `hsv` stay empty. Reason of a rejection: "no segment in the box".
  Segmentation segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                       const Pose& X_WC) override;

 private:
  SegmentConfig config_;
  GeometricConfig geometric_;
  std::map<std::string, StreamInfo::Camera> cameras_;
};

}  // namespace waretwin
