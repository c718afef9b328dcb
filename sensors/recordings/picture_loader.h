// From pictures as they are stored to those of a frame: decoded, undistorted, turned upright, depth in metres.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "sensors/lens.h"
#include "sensors/measurements.h"
#include "sensors/recordings/contents.h"
#include "sensors/recordings/recorded_image.h"

namespace waretwin {

// A pinhole camera after its pictures were turned clockwise by quarter turns, and the pose of the camera that took the turned pictures in
// the frame of the one that took the stored ones.
struct TurnedCamera {
  Intrinsics intrinsics;
  Pose X_CT = Pose::Identity();
};
TurnedCamera turned_camera(const Intrinsics& stored, int quarter_turns);

class PictureLoader {
 public:
  struct Plan {
    Lens stored;            // of the pictures as they are stored
    Intrinsics view;        // the pinhole view that they are resampled to where the lens distorts, of the same size
    int quarter_turns = 0;  // clockwise, [0, 3]
    DepthUnits units;
    std::optional<Intrinsics> native;  // the depth camera's own; never turned
  };
  explicit PictureLoader(Plan plan);

  // Throws Error naming the picture where it is damaged or of another size than the camera's.
  void load(const RecordedFrame& recorded, RgbdFrame& frame) const;

 private:
  cv::Mat upright(const cv::Mat& stored, int interpolation) const;

  Plan plan_;
  cv::Mat map_;  // CV_32FC2: where the view's pixels lie in the stored picture; empty without distortion
};

}  // namespace waretwin
