// Stage 4 of the pipeline (section 3.3): which mapped object a segmented one is, and the update of the mapped object.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "mapper/object_list.h"
#include "mapper/segment/segmenter.h"

namespace waretwin {

struct AssociationContext {
  int frame_id = 0;  // counts mapped frames
  Stamp stamp = 0;
  Pose X_WC = Pose::Identity();
  Intrinsics intrinsics;
  cv::Mat depth;                      // the frame's, CV_32FC1 in metres; may be empty
  std::vector<Detection> detections;  // all of the frame, whatever became of them
  bool tells_nothing = false;         // Segmentation::tells_nothing
};

class Associator {
 public:
  virtual ~Associator() = default;
  // Updates `map` (objects are merged, added, or taken out) and returns one map id per segmented object; 0 = belongs to none.
  // An id that was given once never comes to mean another object.
  virtual std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) = 0;
  // Ids that were merged into another one since the last call, old -> new, for whoever keeps labels by id; 0: into the background.
  virtual std::vector<std::pair<int, int>> take_merges() { return {}; }
  // After the last frame: what was put off until now.
  virtual void finish(ObjectList& map) { (void)map; }
};

}  // namespace waretwin
