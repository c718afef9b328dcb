// Stage 2 of the pipeline: what stands where in the colour image.
#pragma once

#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

#include "mapper/detect/mask_runs.h"
#include "sensors/measurements.h"

namespace waretwin {

struct Detection {
  std::string class_name;
  cv::Rect2f box;      // pixels of the colour image: pixel (u, v) covers [u, u + 1) x [v, v + 1); inside the image
  float score = 1.0f;  // [0, 1]
  MaskRuns mask = {};  // of the colour image, empty where the detector finds boxes alone
};

class Detector {
 public:
  virtual ~Detector() = default;
  // Boxes in any order. No detection is an ordinary result.
  virtual std::vector<Detection> detect(const RgbdFrame& frame) = 0;
};

}  // namespace waretwin
