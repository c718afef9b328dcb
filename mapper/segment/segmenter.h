// Stage 3 of the pipeline (section 3.2 of the paper): from boxes to object points and cuboids, one frame at a time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/cuboid.h"
#include "core/pose.h"
#include "mapper/detect/detector.h"
#include "sensors/intrinsics.h"

namespace waretwin {

enum class RayKind : std::uint8_t { object, other, unknown };

// One pixel with depth: where its ray ended, and whether that is the detected object.
struct EvidenceRay {
  Eigen::Vector3f hit_W = Eigen::Vector3f::Zero();  // metres
  RayKind kind = RayKind::unknown;
  bool level = false;  // it ended on a level surface
};

struct SegmentedObject {
  Detection detection;                    // without its mask
  std::vector<int> pixels;                // v * width + u of the object's pixels in the frame, ascending
  std::vector<Eigen::Vector3f> points_W;  // one per pixel, same order
  Cuboid cuboid;                          // around points_W, frame "world"
  std::vector<float> hsv;                 // colour histogram of the box, for eq. (4)
  // Profile best: what the rays in and around the box tell, and where they start; the height of
  // what the object stands on, where it is not the ground, and that of the ground (-infinity where none is known).
  std::vector<EvidenceRay> rays = {};
  Eigen::Vector3d rays_from_W = Eigen::Vector3d::Zero();
  std::optional<double> support_W = std::nullopt;
  double ground_W = 0.0;
  // Profile voxbloxpp: which of the frame's detections the segment is part of; -1 = background, `detection` is then empty.
  int detection_index = -1;
};

struct Segmentation {
  std::vector<SegmentedObject> objects;
  // The frame was left out as a whole (taken in fast rotation): that an object was not found in it means nothing.
  bool tells_nothing = false;
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
