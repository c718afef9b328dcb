// Object segmentation as in section 3.2 of the paper.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapper/segment/segment_config.h"
#include "mapper/segment/segmenter.h"
#include "mapper/segment/support_plane.h"
#include "sensors/sensor_stream.h"

namespace waretwin {

// Points in the box, without ground and (option) support plane; outlier removal, clusters and the 70 % rule; cuboid by heading search.
// Heights are measured along StreamInfo::up_W; cuboids stand upright on the world's x-y plane all the same (core/cuboid.h), so they are
// of use only where up_W is z.
class PaperSegmenter : public Segmenter {
 public:
  PaperSegmenter(const SegmentConfig& config, const StreamInfo& info);

  // Frame and intrinsics of one size, detections in any order; the objects come in the order of the detections that led to one, tables
  // (config.cut_first) first. Reasons in Segmentation::rejected: "no depth", "only ground or support", "no cluster with the
  // required share of points", "too few points".
  Segmentation segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                       const Pose& X_WC) override;

 private:
  struct Levels {
    double ground = 0.0;             // height along up_W
    double ground_clearance = 0.0;   // points up to this far above it are removed
    std::vector<double> horizontal;  // heights of all horizontal planes
  };
  struct Context;

  Levels find_levels(const Context& context) const;
  std::optional<SupportPlane> support_of(const Context& context, const cv::Rect2f& box, const Levels& levels) const;
  // The reason of a rejection; empty where `object` was filled.
  std::string segment_one(const Context& context, const Levels& levels, const std::vector<char>& taken, SegmentedObject& object) const;

  SegmentConfig config_;
  std::map<std::string, StreamInfo::Camera> cameras_;
  Eigen::Vector3d up_W_;
};

}  // namespace waretwin
