// Association and update of objects in profile best: by shared space, with the evidence of all frames.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "mapper/associate/associator.h"
#include "mapper/associate/box_views.h"
#include "mapper/associate/evidence_config.h"
#include "mapper/associate/evidence_grid.h"

namespace waretwin {

// A detection is the mapped object of its class that holds at least min_overlap of its points and has the largest sum of that share and of
// the 2D IoU between both boxes; within a frame pairs are one to one. Its rays are added to the object's evidence grid, from which the
// cuboid is searched every shape_every observations and at the end, ever less often as observations add up. Mapped objects that come to
// share most of the smaller one's volume, or of which one explains the other's boxes, become one, the older id stays; but if a frame showed
// both side by side, the better one alone stays at the end, or both if many frames did. At the end objects seen too seldom, and those that
// frames in full view of them did not detect, are taken out.
class EvidenceAssociator : public Associator {
 public:
  explicit EvidenceAssociator(const EvidenceConfig& config) : config_(config) {}

  std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) override;
  std::vector<std::pair<int, int>> take_merges() override;
  void finish(ObjectList& map, const TsdfVolume& volume) override;

 private:
  struct Track {
    explicit Track(const EvidenceConfig& config) : grid(config), views(static_cast<std::size_t>(config.box_views)) {}
    EvidenceGrid grid;
    BoxViews views;
    std::vector<float> supports;  // heights, one a frame that found one
    std::vector<float> grounds;   // heights, one a frame
    // The first frames, until the support is settled: what a single frame takes for it may be wrong.
    std::vector<SegmentedObject> pending;
    int shaped_at = 0;  // observations when the cuboid was searched
    int resumed = 0;    // observations that a resumed map came with
    int misses = 0;     // frames in full view of it without a detection
  };

  void adopt(const ObjectList& map);
  void update(MappedObject& mapped, Track& track, const SegmentedObject& object, const AssociationContext& context);
  double support_of(const Track& track) const;
  void add_rays(Track& track, const SegmentedObject& object) const;
  void shape(MappedObject& mapped, Track& track) const;
  void count_misses(const AssociationContext& context, const ObjectList& map);
  // True where the other's boxes are matched by this one's cuboid, and no worse than by its own: clutter that was taken for it.
  bool explains(const MappedObject& one, const MappedObject& other) const;
  bool untouched(const MappedObject& mapped) const;
  int frames_together(const MappedObject& one, const MappedObject& other) const;
  // True where both are in one place, or one explains the other's boxes.
  bool share_space(const MappedObject& one, const MappedObject& other) const;
  void keep_apart(int gone, int stays);
  void merge_overlapping(ObjectList& map);
  void drop_doubles(ObjectList& map);

  EvidenceConfig config_;
  int next_id_ = 1;
  std::map<int, Track> tracks_;               // by map id
  std::map<std::pair<int, int>, int> apart_;  // frames that showed both of two ids
  std::vector<std::pair<int, int>> merges_;
};

}  // namespace waretwin
