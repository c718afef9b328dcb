#include "mapper/associate/segment_associator.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/parallel.h"
#include "core/pose.h"
#include "mapper/integrate/label_surface.h"
#include "mapper/segment/cuboid_search.h"

namespace waretwin {
namespace {

Eigen::AlignedBox3d box_around(const std::vector<Eigen::Vector3f>& points) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points) box.extend(p);
  return box.cast<double>();
}

}  // namespace

std::vector<int> SegmentAssociator::associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context,
                                              ObjectList& map) {
  adopt(map);
  std::vector<VoxelOverlap> overlaps(objects.size());
  if (context.volume) {
    parallel_for(objects.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) overlaps[i] = voxel_overlap(objects[i].points_W, *context.volume);
    });
  }
  std::vector<int> labels = match_labels(overlaps, config_.min_label_voxels);
  for (int& label : labels) {
    if (label == 0) label = next_id_++;
  }
  if (config_.merge) merge_segments(overlaps, labels);
  for (std::size_t i = 0; i < objects.size(); ++i) extend(labels[i], box_around(objects[i].points_W));
  vote(objects, labels, context.frame_id);
  if (context.volume) list_objects(*context.volume, map);
  return labels;
}

std::vector<std::pair<int, int>> SegmentAssociator::take_merges() { return std::exchange(merges_, {}); }

int SegmentAssociator::object_of(int label) const {
  const int instance = records_.instance_of(label);
  return listed_.contains(instance) ? instance : 0;
}

void SegmentAssociator::finish(ObjectList& map, const TsdfVolume& volume) {
  adopt(map);
  list_objects(volume, map);
  for (const int label : records_.segments()) merges_.emplace_back(label, object_of(label));
}

void SegmentAssociator::adopt(const ObjectList& map) {
  for (const MappedObject& mapped : map) {
    if (mapped.id < next_id_) continue;
    next_id_ = mapped.id + 1;
    seen_[mapped.id] = mapped;
    extend(mapped.id, box_around(mapped.points_W));
    seen_[mapped.id].points_W.clear();
    records_.see(mapped.id, mapped.id, mapped.class_name, std::max(1, mapped.observations));
  }
}

void SegmentAssociator::merge_segments(const std::vector<VoxelOverlap>& overlaps, std::vector<int>& labels) {
  std::set<std::pair<int, int>> pairs;  // of this frame
  for (const VoxelOverlap& overlap : overlaps) {
    std::vector<int> enough;
    for (const auto& [label, voxels] : overlap.labels) {
      if (voxels >= config_.merging_min_overlap_ratio * overlap.voxels && voxels >= config_.min_label_voxels) enough.push_back(label);
    }
    for (std::size_t a = 0; a < enough.size(); ++a) {
      for (std::size_t b = a + 1; b < enough.size(); ++b) pairs.emplace(enough[a], enough[b]);
    }
  }
  for (const auto& pair : pairs) ++joined_[pair];
  for (auto entry = joined_.begin(); entry != joined_.end();) {
    if (entry->second < config_.merging_min_frame_count) {
      ++entry;
      continue;
    }
    const auto [stays, gone] = entry->first;
    absorb(gone, stays, labels);
    entry = joined_.begin();  // the pairs of `gone` are now those of `stays`
  }
}

void SegmentAssociator::absorb(int gone, int stays, std::vector<int>& labels) {
  merges_.emplace_back(gone, stays);
  records_.merge(gone, stays);
  extend(stays, extents_[gone]);
  extents_.erase(gone);
  std::replace(labels.begin(), labels.end(), gone, stays);
  std::map<std::pair<int, int>, int> joined;
  for (const auto& [pair, frames] : joined_) {
    const int a = pair.first == gone ? stays : pair.first, b = pair.second == gone ? stays : pair.second;
    if (a == b) continue;
    // Frames that joined a third segment to both are the same ones, as far as is known.
    int& count = joined[std::minmax(a, b)];
    count = std::max(count, frames);
  }
  joined_ = std::move(joined);
}

void SegmentAssociator::vote(const std::vector<SegmentedObject>& objects, const std::vector<int>& labels, int frame_id) {
  std::size_t things = 0;
  std::vector<std::pair<int, std::size_t>> members;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].detection_index < 0) continue;
    const auto thing = static_cast<std::size_t>(objects[i].detection_index);
    members.emplace_back(labels[i], thing);
    things = std::max(things, thing + 1);
  }
  std::vector<int> instances = records_.match_instances(members, things);
  std::set<int> now;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].detection_index < 0) {
      records_.see(labels[i], 0, "");
      continue;
    }
    int& instance = instances[static_cast<std::size_t>(objects[i].detection_index)];
    if (instance == 0) instance = next_id_++;
    records_.see(labels[i], instance, objects[i].detection.class_name);
    if (!now.insert(instance).second) continue;
    MappedObject& seen = seen_[instance];
    if (seen.id == 0) seen.first_frame = frame_id;
    seen.id = instance;
    seen.last_frame = frame_id;
    seen.score = objects[i].detection.score;
    seen.box = objects[i].detection.box;
    ++seen.observations;
  }
}

void SegmentAssociator::list_objects(const TsdfVolume& volume, ObjectList& map) {
  const std::map<int, std::vector<int>> instances = records_.instances();
  const double reach = label_reach_m(volume.config());
  std::map<std::int32_t, Eigen::AlignedBox3d> wanted;
  for (const auto& [instance, segments] : instances) {
    for (const int segment : segments) {
      const Eigen::AlignedBox3d& points_W = extents_.at(segment);
      wanted[segment] = {points_W.min().array() - reach, points_W.max().array() + reach};
    }
  }
  const auto surface = label_surface(volume, wanted);
  map.clear();
  listed_.clear();
  for (const auto& [instance, segments] : instances) {
    MappedObject object = seen_.at(instance);
    for (const int segment : segments) {
      const auto points = surface.find(segment);
      if (points != surface.end()) object.points_W.insert(object.points_W.end(), points->second.begin(), points->second.end());
    }
    if (static_cast<int>(object.points_W.size()) < config_.min_object_points) continue;
    object.class_name = records_.class_of(segments);
    object.cuboid = search_cuboid(object.points_W, to_radians(config_.heading_step_deg));
    listed_.insert(instance);
    map.push_back(std::move(object));
  }
}

}  // namespace waretwin
