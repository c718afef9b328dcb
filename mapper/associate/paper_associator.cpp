#include "mapper/associate/paper_associator.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "mapper/associate/similarity.h"
#include "mapper/segment/cuboid_search.h"

namespace waretwin {

std::vector<int> PaperAssociator::associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context,
                                            ObjectList& map) {
  // A resumed map brings ids of its own.
  for (const MappedObject& mapped : map) next_id_ = std::max(next_id_, mapped.id + 1);

  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // -IoU, object, mapped
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = 0; k < map.size(); ++k) {
      const double iou = iou_3d(objects[i].cuboid, map[k].cuboid);
      if (associated(objects[i], map[k], context, iou)) pairs.emplace_back(-iou, i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> partner(objects.size(), kNone);
  std::vector<char> used(map.size(), 0);
  for (const auto& [negative_iou, i, k] : pairs) {
    if (partner[i] != kNone || used[k]) continue;
    partner[i] = k;
    used[k] = 1;
  }

  std::vector<int> ids(objects.size(), 0);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const SegmentedObject& object = objects[i];
    if (object.points_W.empty()) continue;
    if (partner[i] == kNone) {
      map.emplace_back();
      map.back().id = next_id_++;
      map.back().first_frame = context.frame_id;
    }
    MappedObject& mapped = partner[i] == kNone ? map.back() : map[partner[i]];
    mapped.class_name = object.detection.class_name;
    mapped.score = object.detection.score;
    mapped.last_frame = context.frame_id;
    ++mapped.observations;
    mapped.box = object.detection.box;
    mapped.hsv = object.hsv;
    accumulate(mapped, object.points_W);
    mapped.cuboid = search_cuboid(mapped.points_W, to_radians(config_.heading_step_deg));
    ids[i] = mapped.id;
  }

  const std::size_t merges_before = merges_.size();
  merge_overlapping(map);
  for (std::size_t m = merges_before; m < merges_.size(); ++m) std::replace(ids.begin(), ids.end(), merges_[m].first, merges_[m].second);
  return ids;
}

std::vector<std::pair<int, int>> PaperAssociator::take_merges() { return std::exchange(merges_, {}); }

bool PaperAssociator::associated(const SegmentedObject& object, const MappedObject& mapped, const AssociationContext& context,
                                 double iou) const {
  if (iou > config_.merge_iou_3d) return true;
  if (object.detection.class_name != mapped.class_name) return false;                                                      // eq. (1)
  if (config_.max_frame_gap > 0 && std::abs(context.frame_id - mapped.last_frame) >= config_.max_frame_gap) return false;  // eq. (2)
  if (!(iou > config_.min_iou_3d)) return false;                                                                           // eq. (5)
  double overlap = 0.0;                                                                                                    // eq. (3)
  if (config_.iou2d_mode == "projected") {
    const auto box = projected_box(mapped.cuboid, context.X_WC, context.intrinsics);
    overlap = box ? iou_2d(object.detection.box, *box) : 0.0;
  } else {
    overlap = iou_2d(object.detection.box, mapped.box);
  }
  if (!(overlap > config_.min_iou_2d)) return false;
  const double correlation = config_.correlation == "literal" ? literal_correlation(object.hsv, mapped.hsv)
                                                              : normalised_correlation(object.hsv, mapped.hsv);  // eq. (4)
  return correlation > config_.min_correlation;
}

void PaperAssociator::accumulate(MappedObject& mapped, const std::vector<Eigen::Vector3f>& points_W) {
  if (config_.point_voxel_m <= 0.0) {
    mapped.points_W.insert(mapped.points_W.end(), points_W.begin(), points_W.end());
    return;
  }
  const auto key = [&](const Eigen::Vector3f& p_W) {
    VoxelKey voxel{};
    for (int axis = 0; axis < 3; ++axis) voxel[axis] = static_cast<std::int32_t>(std::floor(p_W[axis] / config_.point_voxel_m));
    return voxel;
  };
  std::set<VoxelKey>& voxels = voxels_[mapped.id];
  if (voxels.empty()) {
    for (const Eigen::Vector3f& p_W : mapped.points_W) voxels.insert(key(p_W));
  }
  for (const Eigen::Vector3f& p_W : points_W) {
    if (voxels.insert(key(p_W)).second) mapped.points_W.push_back(p_W);
  }
}

void PaperAssociator::merge_overlapping(ObjectList& map) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    for (std::size_t k = i + 1; k < map.size();) {
      if (map[i].class_name != map[k].class_name || !(iou_3d(map[i].cuboid, map[k].cuboid) > config_.merge_iou_3d)) {
        ++k;
        continue;
      }
      MappedObject gone = std::move(map[k]);
      map.erase(map.begin() + static_cast<std::ptrdiff_t>(k));
      MappedObject& stays = map[i];
      const int older = std::min(stays.id, gone.id), newer = std::max(stays.id, gone.id);
      accumulate(stays, gone.points_W);
      if (older != stays.id) voxels_[older] = std::move(voxels_[stays.id]);
      voxels_.erase(newer);
      stays.id = older;
      merges_.emplace_back(newer, older);
      if (gone.last_frame > stays.last_frame) {
        stays.box = gone.box;
        stays.hsv = gone.hsv;
        stays.score = gone.score;
      }
      stays.first_frame = std::min(stays.first_frame, gone.first_frame);
      stays.last_frame = std::max(stays.last_frame, gone.last_frame);
      stays.observations += gone.observations;
      stays.cuboid = search_cuboid(stays.points_W, to_radians(config_.heading_step_deg));
      k = i + 1;  // a larger cuboid may overlap what it did not before
    }
  }
}

}  // namespace waretwin
