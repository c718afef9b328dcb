// Detection without a network: boxes that somebody else found, and none at all.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "core/stamp.h"
#include "mapper/detect/detector.h"

namespace waretwin {

// Boxes from a JSON file:
//   {"frames": [{"stamp": NANOSECONDS, "detections": [{"class": "conveyor", "box": [x, y, width, height], "score": 0.9}]}]}
// Boxes in pixels of the colour image as in Detection; "score" may be left out (1). A frame takes the entry nearest to its stamp within
// 1 ms (recordings round stamps); frames that the file does not name have no detections.
class BoxesDetector : public Detector {
 public:
  // Throws Error naming file, frame and key where the file is no such JSON.
  explicit BoxesDetector(const std::filesystem::path& file);
  // Boxes are cut off at the picture's edges; those outside are dropped.
  std::vector<Detection> detect(const RgbdFrame& frame) override;

 private:
  std::map<Stamp, std::vector<Detection>> frames_;
};

class NoDetector : public Detector {
 public:
  std::vector<Detection> detect(const RgbdFrame&) override { return {}; }
};

}  // namespace waretwin
