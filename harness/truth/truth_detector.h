// Boxes from the instance image of the same rays that made the colour picture: what a faultless detector would find.
#pragma once

#include "core/fields.h"
#include "mapper/detect/detector.h"
#include "sim/simulated_stream.h"

namespace waretwin {

struct TruthDetectorConfig {
  int min_pixels = 2000;           // of the object in the picture
  int min_depth_pixels = 200;      // of these, with depth
  double min_visible_share = 0.3;  // visible box's area over that of the whole object's box, parts beyond the picture included
  bool masks = false;              // the visible pixels, too, as a faultless instance segmentation finds them
  void visit(Fields& f);
};

// One box per true object in view: the smallest one around its visible pixels, score 1, in order of ids; with `masks`
// those pixels, too. Only classes of the truth.
class TruthDetector : public Detector {
 public:
  // The stream must outlive the detector; its newest frame is the one that is asked for.
  TruthDetector(const SimulatedStream& stream, const TruthDetectorConfig& config) : stream_(stream), config_(config) {}
  std::vector<Detection> detect(const RgbdFrame& frame) override;

 private:
  const SimulatedStream& stream_;
  TruthDetectorConfig config_;
};

// The boxes of one frame from its images. `instances` CV_16UC1, `depth` CV_32FC1 of the same size.
std::vector<Detection> boxes_from_instances(const cv::Mat& instances, const cv::Mat& depth, const std::vector<TrueObject>& objects,
                                            const Intrinsics& intrinsics, const Pose& X_WC, const TruthDetectorConfig& config);

}  // namespace waretwin
