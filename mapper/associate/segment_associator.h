// Association and update of objects in profile voxbloxpp: segments are found again by the voxels they share with the labelled volume, and
// an object is what the segments of one instance are together (Grinvald et al. 2019, sections III-C to III-E).
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mapper/associate/associator.h"
#include "mapper/associate/segment_records.h"
#include "mapper/associate/segments_config.h"
#include "mapper/associate/voxel_overlap.h"

namespace waretwin {

// A segment of a frame is the mapped one with which it shares most voxels; each mapped one is found once a frame at most, and what is left
// over is new. Two mapped segments that enough frames see as one become one, the older label stays. Instances: segment_records.h. An
// object's points are the volume's surface where it carries the labels of the instance's segments, and its cuboid is the smallest upright
// box around them: it reaches as far as the object was seen. Labels and object ids come from one counter, so that none means two things.
class SegmentAssociator : public Associator {
 public:
  explicit SegmentAssociator(const SegmentsConfig& config) : config_(config), records_(config.background_factor) {}

  // Takes all segments of the frame, those of the background too (SegmentedObject::detection_index), and returns their labels: these
  // are not map ids, see object_of. Objects in `map` are as the frames before show them.
  std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) override;
  std::vector<std::pair<int, int>> take_merges() override;
  int object_of(int label) const override;
  void finish(ObjectList& map, const TsdfVolume& volume) override;

 private:
  // Objects of a resumed map are one segment each; the rest of its volume is not segmented.
  void adopt(const ObjectList& map);
  void merge_segments(const std::vector<VoxelOverlap>& overlaps, std::vector<int>& labels);
  void absorb(int gone, int stays, std::vector<int>& labels);
  void vote(const std::vector<SegmentedObject>& objects, const std::vector<int>& labels, int frame_id);
  // Where the volume may carry a label: around all points that were given it.
  void extend(int label, const Eigen::AlignedBox3d& points_W) { extents_[label].extend(points_W); }
  void list_objects(const TsdfVolume& volume, ObjectList& map);

  SegmentsConfig config_;
  SegmentRecords records_;
  int next_id_ = 1;
  std::map<std::pair<int, int>, int> joined_;   // frames that saw two mapped segments as one; smaller label first
  std::map<int, MappedObject> seen_;            // by instance: all but class, points and cuboid
  std::set<int> listed_;                        // instances in the map
  std::map<int, Eigen::AlignedBox3d> extents_;  // by label, metres in W
  std::vector<std::pair<int, int>> merges_;
};

}  // namespace waretwin
