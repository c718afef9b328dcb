// Stage 4 of the pipeline (section 3.3): which mapped object a segmented one is, and the update of the mapped object.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "mapper/integrate/tsdf_volume.h"
#include "mapper/object_list.h"
#include "mapper/segment/segmenter.h"

namespace waretwin {

struct AssociationContext {
  int frame_id = 0;  // counts mapped frames
  Stamp stamp = 0;
  Pose X_WC = Pose::Identity();
  Intrinsics intrinsics;
  cv::Mat depth;                       // the frame's, CV_32FC1 in metres; may be empty
  std::vector<Detection> detections;   // all of the frame, whatever became of them
  bool tells_nothing = false;          // Segmentation::tells_nothing
  const TsdfVolume* volume = nullptr;  // as the frames before left it, with the labels that `associate` returned; may be missing
};

class Associator {
 public:
  virtual ~Associator() = default;
  // Updates `map` (objects are merged, added, or taken out) and returns one label per segmented object for the volume; 0 = belongs to none.
  // It is the map id of the object, unless the profile labels the volume by parts of objects (object_of). An id or label that was given
  // once never comes to mean anything else.
  virtual std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) = 0;
  // Ids that were merged into another one since the last call, old -> new, for whoever keeps labels by id; 0: into the background.
  virtual std::vector<std::pair<int, int>> take_merges() { return {}; }
  // The map id of the object that a label is a part of as things stand; 0 = of none.
  virtual int object_of(int label) const { return label; }
  // After the last frame: what was put off until now. `volume` holds all frames. When take_merges() was applied after it, all of the
  // volume's labels are ids of objects.
  virtual void finish(ObjectList& map, const TsdfVolume& volume) { (void)map, (void)volume; }
};

}  // namespace waretwin
