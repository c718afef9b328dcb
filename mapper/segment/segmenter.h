// Stage 3 of the pipeline (section 3.2 of the paper): from boxes to object points and cuboids, one frame at a time.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "core/cuboid.h"
#include "core/pose.h"
#include "mapper/detect/detector.h"
#include "sensors/intrinsics.h"

namespace waretwin {

struct SegmentedObject {
  Detection detection;
  std::vector<int> pixels;                // v * width + u of the object's pixels in the frame, ascending
  std::vector<Eigen::Vector3f> points_W;  // one per pixel, same order
  Cuboid cuboid;                          // around points_W, frame "world"
  std::vector<float> hsv;                 // colour histogram of the box, for eq. (4)
};

struct Segmentation {
  std::vector<SegmentedObject> objects;
  // Why detections came to nothing ("no depth", "cluster below 70 %"): counted in reports, never an error.
  std::map<std::string, int> rejected;
};

class Segmenter {
 public:
  virtual ~Segmenter() = default;
  virtual Segmentation segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                               const Pose& X_WC) = 0;
};

}  // namespace waretwin
