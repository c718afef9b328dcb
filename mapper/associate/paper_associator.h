// Association and update of objects as in section 3.3 of the paper, eqs. (1) to (5).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "mapper/associate/associate_config.h"
#include "mapper/associate/associator.h"

namespace waretwin {

// A pair is associated where class, frame gap, 2D IoU, colour and 3D IoU all agree, or where the 3D IoU alone exceeds the merging limit.
// Within a frame pairs are one to one, taken by falling 3D IoU (then by index). The matched object takes over class, 2D box and colours,
// gets the points added (one a voxel, the first that fell into it, so that memory is bounded by the object's surface), and its cuboid is
// searched again around all of them. Mapped objects of one class that then overlap beyond the merging limit become one: the older id stays.
class PaperAssociator : public Associator {
 public:
  explicit PaperAssociator(const AssociateConfig& config) : config_(config) {}

  std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) override;
  std::vector<std::pair<int, int>> take_merges() override;

 private:
  using VoxelKey = std::array<std::int32_t, 3>;

  bool associated(const SegmentedObject& object, const MappedObject& mapped, const AssociationContext& context, double iou_3d) const;
  void accumulate(MappedObject& mapped, const std::vector<Eigen::Vector3f>& points_W);
  void merge_overlapping(ObjectList& map);

  AssociateConfig config_;
  int next_id_ = 1;
  std::map<int, std::set<VoxelKey>> voxels_;  // by map id: which voxels hold a point already
  std::vector<std::pair<int, int>> merges_;
};

}  // namespace waretwin
