#include "harness/score/explain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/pose.h"

namespace waretwin {

namespace {

constexpr double kFace = 0.03;    // metres: a face nearer to the true one is not worth a word
constexpr double kPlace = 0.05;   // metres
constexpr double kTurned = 5.0;   // degrees
constexpr double kOverlap = 0.3;  // of the smaller box: two boxes share a place

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", value);
  return text;
}

std::string share(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

const ListedObject* with_id(const std::vector<ListedObject>& objects, int id) {
  const auto found = std::find_if(objects.begin(), objects.end(), [id](const ListedObject& object) { return object.id == id; });
  return found == objects.end() ? nullptr : &*found;
}

// Shared volume over the volume of `part`.
double share_of(const Cuboid& part, const Cuboid& whole) {
  return part.volume() > 0.0 ? intersection_volume(part, whole) / part.volume() : 0.0;
}

// Other true objects of which `mapped` covers a good part.
std::string also_covered(const ListedObject& mapped, const std::vector<ListedObject>& truth, int but_not) {
  std::string ids;
  for (const ListedObject& other : truth) {
    if (other.id == but_not || other.class_name != mapped.class_name || share_of(other.cuboid, mapped.cuboid) < kOverlap) continue;
    ids += (ids.empty() ? "" : ", ") + std::to_string(other.id);
  }
  return ids;
}

// How far the mapped box reaches beyond the true one at the true one's faces, negative where it falls short. Metres; -x, +x, -y, +y, -z,
// +z.
std::array<double, 6> reach_beyond(const Cuboid& mapped, const Cuboid& truth) {
  const Pose X_TW = truth.pose().inverse();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector3d& corner : mapped.corners()) {
    const Eigen::Vector3d p_T = X_TW * corner;
    low = low.cwiseMin(p_T);
    high = high.cwiseMax(p_T);
  }
  std::array<double, 6> beyond{};
  for (int axis = 0; axis < 3; ++axis) {
    beyond[static_cast<std::size_t>(2 * axis)] = -0.5 * truth.size[axis] - low[axis];
    beyond[static_cast<std::size_t>(2 * axis + 1)] = high[axis] - 0.5 * truth.size[axis];
  }
  return beyond;
}

std::string about_faces(const Cuboid& mapped, const Cuboid& truth, bool turned) {
  const std::array<double, 6> beyond = reach_beyond(mapped, truth);
  std::string text;
  const auto say = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (beyond[4] > kFace) say("support plane kept: reaches " + metres(beyond[4]) + " below its foot");
  if (beyond[4] < -kFace) say("lower part missing: ends " + metres(-beyond[4]) + " above its foot");
  if (beyond[5] > kFace) say("something on top kept: " + metres(beyond[5]) + " too high");
  if (beyond[5] < -kFace) say("top missing: " + metres(-beyond[5]) + " too low");
  // A turned box sticks out everywhere.
  if (turned) return text;
  const Eigen::Vector3d offset = truth.pose().inverse() * mapped.centre;
  for (int axis = 0; axis < 2; ++axis) {
    const double longer = mapped.size[axis] - truth.size[axis];
    const std::string name = axis == 0 ? "long" : "short";
    const auto minus = beyond[static_cast<std::size_t>(2 * axis)], plus = beyond[static_cast<std::size_t>(2 * axis + 1)];
    if (std::max(std::abs(minus), std::abs(plus)) <= kFace) continue;
    if (std::abs(longer) <= kFace) {
      say("shifted by " + metres(std::abs(offset[axis])) + " along its " + name + " side");
    } else if (longer < 0.0) {
      say("half seen: " + metres(-longer) + " short along its " + name + " side");
    } else {
      say("grown: " + metres(longer) + " too much along its " + name + " side");
    }
  }
  return text;
}

std::string about_missing(const ListedObject& object, const std::vector<ListedObject>& mapped, const ObjectListScore& score,
                          const ScoringRules& rules) {
  for (const ObjectScore& row : score.objects) {
    const ListedObject* other = row.map_id && row.truth_id != object.id ? with_id(mapped, *row.map_id) : nullptr;
    if (other && other->class_name == object.class_name && share_of(object.cuboid, other->cuboid) >= kOverlap) {
      return "merged with " + std::to_string(row.truth_id) + ": mapped object " + std::to_string(other->id) + " spans both";
    }
  }
  for (const ListedObject& other : mapped) {
    if (other.class_name != object.class_name && share_of(object.cuboid, other.cuboid) >= kOverlap) {
      return "mapped as " + other.class_name + " (object " + std::to_string(other.id) + ")";
    }
  }
  double nearest = std::numeric_limits<double>::infinity();
  int id = 0;
  for (const ListedObject& other : mapped) {
    const double distance = (other.cuboid.centre - object.cuboid.centre).norm();
    if (other.class_name != object.class_name || distance >= nearest) continue;
    nearest = distance;
    id = other.id;
  }
  const std::string seen = ", though " + share(object.visible_fraction) + " of its surface was seen";
  if (nearest < 2.0 * rules.max_centre_distance_m) {
    return "not in the map where it stands" + seen + "; the nearest mapped " + object.class_name + " (" + std::to_string(id) + ") is " +
           metres(nearest) + " away";
  }
  return "not in the map" + seen;
}

std::string about_pair(const ListedObject& mapped, const ListedObject& object, const ObjectScore& row,
                       const std::vector<ListedObject>& truth) {
  const std::string merged = also_covered(mapped, truth, object.id);
  if (!merged.empty()) return "merged with " + merged + ": mapped object " + std::to_string(mapped.id) + " spans them too";
  std::string text;
  const auto say = [&](const std::string& what) {
    if (!what.empty()) text += (text.empty() ? "" : "; ") + what;
  };
  const double yaw = row.e_rot_deg.value_or(0.0);
  const bool turned = yaw > kTurned;
  if (turned) say("yaw " + std::to_string(static_cast<int>(std::lround(yaw))) + " deg off");
  say(about_faces(mapped.cuboid, object.cuboid, turned));
  if (text.empty() && row.e_trans_m.value_or(0.0) > kPlace) say("shifted by " + metres(*row.e_trans_m));
  if (text.empty()) say("each face within " + metres(kFace) + " of the true one, yaw within 5 deg: the object is small for such errors");
  return text;
}

std::string about_false_positive(const ListedObject& mapped, const std::vector<ListedObject>& truth, const ObjectListScore& score) {
  for (const ObjectScore& row : score.objects) {
    const ListedObject* object = with_id(truth, row.truth_id);
    if (!object) continue;
    const double overlap = std::max(share_of(mapped.cuboid, object->cuboid), share_of(object->cuboid, mapped.cuboid));
    if (overlap < kOverlap) continue;
    if (object->class_name != mapped.class_name) return "stands where " + object->class_name + " " + std::to_string(object->id) + " is";
    if (row.map_id && *row.map_id != mapped.id) {
      return "second object on " + std::to_string(object->id) + ", which is mapped as " + std::to_string(*row.map_id);
    }
  }
  double nearest = std::numeric_limits<double>::infinity();
  int id = 0;
  for (const ListedObject& object : truth) {
    const double distance = (object.cuboid.centre - mapped.cuboid.centre).norm();
    if (object.class_name != mapped.class_name || distance >= nearest) continue;
    nearest = distance;
    id = object.id;
  }
  if (!std::isfinite(nearest)) return "no true " + mapped.class_name + " anywhere";
  return "nothing of its class there: the nearest true " + mapped.class_name + " (" + std::to_string(id) + ") is " + metres(nearest) +
         " away";
}

}  // namespace

std::vector<Explanation> explain(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth,
                                 const ObjectListScore& score, const ScoringRules& rules, double good_iou) {
  std::vector<Explanation> lines;
  std::vector<int> paired;
  for (const ObjectScore& row : score.objects) {
    const ListedObject* object = with_id(truth, row.truth_id);
    const ListedObject* partner = row.map_id ? with_id(mapped, *row.map_id) : nullptr;
    if (!object) continue;
    if (!row.counted) {
      lines.push_back(
          {row.truth_id, row.map_id,
           (row.visible_fraction > 0.0 ? "half seen: " + share(row.visible_fraction) + " of its surface" : std::string("not seen at all")) +
               ", " + share(rules.min_visible_fraction) + " would count"});
      continue;
    }
    if (!partner) {
      lines.push_back({row.truth_id, std::nullopt, about_missing(*object, mapped, score, rules)});
    } else if (row.iou3d < std::max(good_iou, rules.match_iou)) {
      lines.push_back({row.truth_id, row.map_id, about_pair(*partner, *object, row, truth)});
      paired.push_back(partner->id);
    }
  }
  for (const int id : score.false_positives) {
    // A bad pair was spoken of above.
    if (std::find(paired.begin(), paired.end(), id) != paired.end()) continue;
    if (const ListedObject* object = with_id(mapped, id)) lines.push_back({std::nullopt, id, about_false_positive(*object, truth, score)});
  }
  return lines;
}

}  // namespace waretwin
