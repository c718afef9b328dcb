// Detection without a network: boxes that somebody else found, and none at all.
#pragma once

#include <filesystem>
#include <vector>

#include "mapper/detect/boxes_file.h"

namespace waretwin {

// A frame takes the boxes whose stamp is nearest to its own, within 1 ms (files round stamps); frames that are not named have none.
class BoxesDetector : public Detector {
 public:
  // Throws Error as read_boxes does.
  explicit BoxesDetector(const std::filesystem::path& path, const DetectConfig& config = {});
  // Boxes are cut off at the picture's edges; those outside are dropped. Throws Error for a mask of another size than the picture's.
  std::vector<Detection> detect(const RgbdFrame& frame) override;

 private:
  std::filesystem::path path_;
  FrameBoxes frames_;
};

class NoDetector : public Detector {
 public:
  std::vector<Detection> detect(const RgbdFrame&) override { return {}; }
};

}  // namespace waretwin
