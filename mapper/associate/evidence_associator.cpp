#include "mapper/associate/evidence_associator.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "mapper/associate/evidence_shape.h"
#include "mapper/associate/similarity.h"

namespace waretwin {

namespace {

constexpr std::size_t kOverlapSamples = 2000;

// Where most of the points lie: between the 2nd and the 98th percentile of each axis.
Eigen::AlignedBox3d bulk_of(const std::vector<EvidenceRay>& rays) {
  Eigen::AlignedBox3d box;
  std::vector<float> values;
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const EvidenceRay& ray : rays) {
      if (ray.kind == RayKind::object) values.push_back(ray.hit_W[axis]);
    }
    if (values.empty()) return box;
    const auto at = [&](double order) {
      const auto nth = values.begin() + static_cast<std::ptrdiff_t>(order * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), nth, values.end());
      return static_cast<double>(*nth);
    };
    low[axis] = at(0.02);
    high[axis] = at(0.98);
  }
  return {low, high};
}

// Share of some of the points that lie inside the cuboid, prolonged down to `floor_z`: what is known of an object grows from its top down.
double share_inside(const std::vector<Eigen::Vector3f>& points_W, const Cuboid& cuboid, double floor_z, double margin) {
  if (points_W.empty()) return 0.0;
  const Eigen::Matrix3f R = cuboid.pose().linear().transpose().cast<float>();
  const Eigen::Vector3f centre = cuboid.centre.cast<float>();
  const Eigen::Vector3f half = (0.5 * cuboid.size + Eigen::Vector3d::Constant(margin)).cast<float>();
  const auto low = static_cast<float>(std::min(floor_z, cuboid.bottom()) - margin);
  const std::size_t step = std::max<std::size_t>(1, points_W.size() / kOverlapSamples);
  std::size_t inside = 0, all = 0;
  for (std::size_t i = 0; i < points_W.size(); i += step, ++all) {
    const Eigen::Vector3f p = R * (points_W[i] - centre);
    if (std::abs(p.x()) <= half.x() && std::abs(p.y()) <= half.y() && p.z() <= half.z() && points_W[i].z() >= low) ++inside;
  }
  return static_cast<double>(inside) / static_cast<double>(all);
}

// True where the whole cuboid lies inside the picture and most of it stands before nothing nearer: a detector should have found it.
bool in_full_view(const Cuboid& cuboid, const AssociationContext& context) {
  if (context.depth.empty()) return false;
  constexpr double kBorder = 8.0;  // pixels
  constexpr double kNear = 0.1;    // metres
  const Pose X_CO = context.X_WC.inverse() * cuboid.pose();
  const Intrinsics& intrinsics = context.intrinsics;
  int seen = 0, all = 0;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d corner = Eigen::Vector3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1).cwiseProduct(0.5 * cuboid.size);
    const Eigen::Vector3d p_C = X_CO * corner;
    if (p_C.z() < kNear) return false;
    const Eigen::Vector2d pixel = intrinsics.project(p_C);
    if (!(pixel.x() >= kBorder && pixel.y() >= kBorder && pixel.x() < intrinsics.width - kBorder &&
          pixel.y() < intrinsics.height - kBorder)) {
      return false;
    }
    const float depth = context.depth.at<float>(static_cast<int>(std::lround(pixel.y())), static_cast<int>(std::lround(pixel.x())));
    if (depth <= 0.0f) continue;
    ++all;
    // What lies farther is the object's own far side, or shows that it is gone.
    if (depth > p_C.z() - cuboid.size.norm()) ++seen;
  }
  return all >= 9 && seen >= 0.8 * all;
}

// True where a detection of its class, that came to nothing, may be the object.
bool detected_near(const MappedObject& mapped, const AssociationContext& context) {
  const auto box = projected_box(mapped.cuboid, context.X_WC, context.intrinsics);
  return box && std::any_of(context.detections.begin(), context.detections.end(), [&](const Detection& detection) {
           return detection.class_name == mapped.class_name && iou_2d(detection.box, *box) > 0.1;
         });
}

double median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<int> EvidenceAssociator::associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context,
                                               ObjectList& map) {
  adopt(map);

  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // -(overlap and 2D IoU), object, mapped
  std::vector<double> floors;                                       // of the mapped objects
  for (const MappedObject& mapped : map) floors.push_back(support_of(tracks_.at(mapped.id)));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = 0; k < map.size(); ++k) {
      if (objects[i].detection.class_name != map[k].class_name) continue;
      const double margin = std::min(config_.overlap_margin_m, 0.25 * map[k].cuboid.size.head<2>().minCoeff());
      const double overlap = share_inside(objects[i].points_W, map[k].cuboid, floors[k], margin);
      if (overlap < config_.min_overlap) continue;
      // Of neighbours in one row the points alone do not tell which is meant: each box holds some of the other's.
      const auto box = projected_box(map[k].cuboid, context.X_WC, context.intrinsics);
      const double match = box ? iou_2d(*box, objects[i].detection.box) : 0.0;
      pairs.emplace_back(-(overlap + match), i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> partner(objects.size(), kNone);
  std::vector<char> used(map.size(), 0), contested(objects.size(), 0);
  for (const auto& [negative_value, i, k] : pairs) {
    if (partner[i] != kNone) continue;
    if (used[k]) {
      // A neighbour lies in the margin, a second box in the object itself.
      if (share_inside(objects[i].points_W, map[k].cuboid, floors[k], 0.0) > config_.same_object_share) contested[i] = 1;
      continue;
    }
    partner[i] = k;
    used[k] = 1;
  }

  std::vector<int> ids(objects.size(), 0);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const SegmentedObject& object = objects[i];
    // A second box on an object that has one already is no other object.
    if (partner[i] == kNone && contested[i]) continue;
    if (partner[i] == kNone) {
      Track track(config_);
      MappedObject fresh;
      fresh.id = next_id_;
      fresh.class_name = object.detection.class_name;
      fresh.first_frame = context.frame_id;
      update(fresh, track, object, context);
      if (fresh.cuboid.volume() <= 0.0) continue;
      ++next_id_;
      ids[i] = fresh.id;
      tracks_.emplace(fresh.id, std::move(track));
      map.push_back(std::move(fresh));
      continue;
    }
    MappedObject& mapped = map[partner[i]];
    update(mapped, tracks_.at(mapped.id), object, context);
    ids[i] = mapped.id;
  }

  count_misses(context, map);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = i + 1; k < ids.size(); ++k) {
      if (ids[i] != 0 && ids[k] != 0) ++apart_[std::minmax(ids[i], ids[k])];
    }
  }

  const std::size_t merges_before = merges_.size();
  merge_overlapping(map);
  for (std::size_t m = merges_before; m < merges_.size(); ++m) std::replace(ids.begin(), ids.end(), merges_[m].first, merges_[m].second);
  return ids;
}

// A resumed map brings ids of its own.
void EvidenceAssociator::adopt(const ObjectList& map) {
  for (const MappedObject& mapped : map) {
    next_id_ = std::max(next_id_, mapped.id + 1);
    const auto [track, fresh] = tracks_.try_emplace(mapped.id, config_);
    if (fresh) track->second.resumed = mapped.observations;
  }
}

std::vector<std::pair<int, int>> EvidenceAssociator::take_merges() { return std::exchange(merges_, {}); }

void EvidenceAssociator::update(MappedObject& mapped, Track& track, const SegmentedObject& object, const AssociationContext& context) {
  mapped.score = object.detection.score;
  mapped.last_frame = context.frame_id;
  mapped.box = object.detection.box;
  ++mapped.observations;
  track.views.add({context.X_WC, context.intrinsics, object.detection.box});
  if (object.support_W) track.supports.push_back(static_cast<float>(*object.support_W));
  track.grounds.push_back(static_cast<float>(object.ground_W));
  if (static_cast<int>(track.pending.size()) < config_.shape_every && static_cast<int>(track.grounds.size()) <= config_.shape_every) {
    SegmentedObject& kept = track.pending.emplace_back();
    kept.rays = object.rays;
    kept.rays_from_W = object.rays_from_W;
    track.grid = EvidenceGrid(config_);
    for (const SegmentedObject& earlier : track.pending) add_rays(track, earlier);
    if (static_cast<int>(track.pending.size()) == config_.shape_every) track.pending = {};
    shape(mapped, track);
    return;
  }
  add_rays(track, object);
  // The more is known, the less another frame changes.
  const int next = track.shaped_at + std::max(config_.shape_every, track.shaped_at / 5);
  if (mapped.observations >= next) shape(mapped, track);
}

double EvidenceAssociator::support_of(const Track& track) const {
  const auto found = static_cast<double>(track.supports.size()), all = static_cast<double>(track.grounds.size());
  if (found > 0.0 && found >= config_.support_share * all) return median(track.supports);
  return track.grounds.empty() ? track.grid.origin().z() : median(track.grounds);
}

void EvidenceAssociator::add_rays(Track& track, const SegmentedObject& object) const {
  const auto support = static_cast<float>(support_of(track)), clearance = static_cast<float>(config_.foot_clearance_m);
  std::vector<EvidenceRay> rays = object.rays;
  for (EvidenceRay& ray : rays) {
    if (ray.kind != RayKind::object || ray.hit_W.z() > support + clearance) continue;
    ray.kind = ray.hit_W.z() > support - clearance ? RayKind::unknown : RayKind::other;
  }
  track.grid.add(object.rays_from_W, rays, bulk_of(rays));
}

void EvidenceAssociator::shape(MappedObject& mapped, Track& track) const {
  track.shaped_at = mapped.observations;
  // An archive holds no evidence: a resumed object keeps its cuboid until about as much is known of it again.
  if (2 * static_cast<int>(track.grounds.size()) < track.resumed) return;
  if (const auto cuboid = evidence_cuboid(track.grid, track.views, support_of(track), config_)) mapped.cuboid = *cuboid;
}

void EvidenceAssociator::count_misses(const AssociationContext& context, const ObjectList& map) {
  if (context.tells_nothing) return;
  for (const MappedObject& mapped : map) {
    if (mapped.last_frame == context.frame_id) continue;
    if (detected_near(mapped, context) || !in_full_view(mapped.cuboid, context)) continue;
    ++tracks_.at(mapped.id).misses;
  }
}

// Of a resumed map, and not seen since: nothing is known that could change it.
bool EvidenceAssociator::untouched(const MappedObject& mapped) const {
  const Track& track = tracks_.at(mapped.id);
  return track.resumed > 0 && track.grounds.empty();
}

int EvidenceAssociator::frames_together(const MappedObject& one, const MappedObject& other) const {
  const auto together = apart_.find(std::minmax(one.id, other.id));
  return together == apart_.end() ? 0 : together->second;
}

bool EvidenceAssociator::share_space(const MappedObject& one, const MappedObject& other) const {
  const double smaller = std::min(one.cuboid.volume(), other.cuboid.volume());
  if (one.class_name != other.class_name || smaller <= 0.0) return false;
  if (intersection_volume(one.cuboid, other.cuboid) > config_.merge_overlap * smaller) return true;
  // What was taken for the object at first lies near it: it was in its boxes.
  Cuboid around = one.cuboid;
  around.size += Eigen::Vector3d::Constant(2.0 * config_.stray_reach_m);
  return intersection_volume(around, other.cuboid) > 0.0 && (explains(one, other) || explains(other, one));
}

// What was seen beside the one is beside what it becomes. The two themselves never were: that forbids their merging.
void EvidenceAssociator::keep_apart(int gone, int stays) {
  std::map<std::pair<int, int>, int> renamed;
  for (const auto& [pair, frames] : apart_) {
    const int a = pair.first == gone ? stays : pair.first, b = pair.second == gone ? stays : pair.second;
    renamed[std::minmax(a, b)] += frames;
  }
  apart_ = std::move(renamed);
}

bool EvidenceAssociator::explains(const MappedObject& one, const MappedObject& other) const {
  const BoxViews& views = tracks_.at(other.id).views;
  if (views.empty()) return false;
  const double match = views.match(views.shown(one.cuboid));
  return match >= config_.same_boxes_match && match >= views.match(views.shown(other.cuboid));
}

void EvidenceAssociator::merge_overlapping(ObjectList& map) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    for (std::size_t k = i + 1; k < map.size();) {
      if (untouched(map[i]) || untouched(map[k]) || frames_together(map[i], map[k]) > 0 || !share_space(map[i], map[k])) {
        ++k;
        continue;
      }
      MappedObject gone = std::move(map[k]);
      map.erase(map.begin() + static_cast<std::ptrdiff_t>(k));
      MappedObject& stays = map[i];
      const int older = std::min(stays.id, gone.id), newer = std::max(stays.id, gone.id);
      Track merged = std::move(tracks_.at(stays.id));
      const Track& other = tracks_.at(gone.id);
      merged.grid.add(other.grid);
      merged.views.add(other.views);
      merged.misses += other.misses;
      merged.supports.insert(merged.supports.end(), other.supports.begin(), other.supports.end());
      merged.grounds.insert(merged.grounds.end(), other.grounds.begin(), other.grounds.end());
      merged.pending.insert(merged.pending.end(), other.pending.begin(), other.pending.end());
      if (static_cast<int>(merged.grounds.size()) >= config_.shape_every) merged.pending = {};
      merged.resumed = std::max(merged.resumed, other.resumed);
      tracks_.erase(stays.id);
      tracks_.erase(gone.id);
      keep_apart(newer, older);
      stays.id = older;
      stays.first_frame = std::min(stays.first_frame, gone.first_frame);
      stays.last_frame = std::max(stays.last_frame, gone.last_frame);
      stays.observations += gone.observations;
      shape(stays, merged);
      tracks_.emplace(older, std::move(merged));
      merges_.emplace_back(newer, older);
      k = i + 1;  // a larger cuboid may overlap what it did not before
    }
  }
}

// Neighbours share most of the frames that show one of them. Of two objects in one place that were seen side by side now and then one took
// detections of a neighbour for its own at first. What it knows is spoilt: it goes.
void EvidenceAssociator::drop_doubles(ObjectList& map) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    for (std::size_t k = i + 1; k < map.size();) {
      // Of this run: an archive does not tell which frames showed what.
      const auto seen = static_cast<double>(std::min(tracks_.at(map[i].id).grounds.size(), tracks_.at(map[k].id).grounds.size()));
      const int together = frames_together(map[i], map[k]);
      if (together == 0 || together > config_.neighbour_share * seen || !share_space(map[i], map[k])) {
        ++k;
        continue;
      }
      const auto worth = [&](const MappedObject& mapped) {
        const BoxViews& views = tracks_.at(mapped.id).views;
        return std::pair(views.match(views.shown(mapped.cuboid)), mapped.observations);
      };
      if (worth(map[k]) > worth(map[i])) std::swap(map[i], map[k]);
      const int gone = map[k].id;
      merges_.emplace_back(gone, map[i].id);
      tracks_.erase(gone);
      map.erase(map.begin() + static_cast<std::ptrdiff_t>(k));
      k = i + 1;
    }
  }
}

void EvidenceAssociator::finish(ObjectList& map, const TsdfVolume&) {
  adopt(map);
  for (MappedObject& mapped : map) shape(mapped, tracks_.at(mapped.id));
  merge_overlapping(map);
  drop_doubles(map);
  std::erase_if(map, [&](const MappedObject& mapped) {
    const Track& track = tracks_.at(mapped.id);
    if (track.grounds.empty() && track.misses == 0) return false;  // of a map that is resumed, and nobody looked there
    const bool stray =
        mapped.observations < config_.min_observations || mapped.observations < config_.min_presence * (mapped.observations + track.misses);
    if (stray) merges_.emplace_back(mapped.id, 0);
    return stray;
  });
}

}  // namespace waretwin
