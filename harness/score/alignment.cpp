#include "harness/score/alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace waretwin {

namespace {

const ListedObject& by_id(const std::vector<ListedObject>& objects, int id) {
  const auto found = std::find_if(objects.begin(), objects.end(), [id](const ListedObject& object) { return object.id == id; });
  WARETWIN_CHECK(found != objects.end(), "a score names objects of its lists");
  return *found;
}

}  // namespace

std::optional<Pose> align_map_to_truth(const std::vector<ListedObject>& mapped, const std::vector<ListedObject>& truth,
                                       const ObjectListScore& score) {
  std::vector<const Cuboid*> from, to;
  for (const ObjectScore& row : score.objects) {
    if (!row.map_id || !row.counted) continue;
    from.push_back(&by_id(mapped, *row.map_id).cuboid);
    to.push_back(&by_id(truth, row.truth_id).cuboid);
  }
  if (from.empty()) return std::nullopt;

  Eigen::Vector2d from_mean = Eigen::Vector2d::Zero(), to_mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean += from[i]->centre.head<2>();
    to_mean += to[i]->centre.head<2>();
  }
  from_mean /= static_cast<double>(from.size());
  to_mean /= static_cast<double>(to.size());

  double yaw = 0.0;
  if (from.size() == 1) {
    // A box looks the same after half a turn, a square one after a quarter: the smallest of the motions.
    const bool square = to.front()->size.x() < ScoringRules{}.square_ratio * to.front()->size.y();
    yaw = std::remainder(to.front()->yaw - from.front()->yaw, square ? std::numbers::pi / 2.0 : std::numbers::pi);
  } else {
    double cosine = 0.0, sine = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Eigen::Vector2d a = from[i]->centre.head<2>() - from_mean;
      const Eigen::Vector2d b = to[i]->centre.head<2>() - to_mean;
      cosine += a.dot(b);
      sine += a.x() * b.y() - a.y() * b.x();
    }
    yaw = std::atan2(sine, cosine);
  }
  const Eigen::Vector2d shift = to_mean - Eigen::Rotation2Dd(yaw) * from_mean;
  return make_upright_pose(shift.x(), shift.y(), 0.0, yaw);
}

std::vector<ListedObject> moved(const std::vector<ListedObject>& objects, const Pose& X_TM) {
  std::vector<ListedObject> result = objects;
  for (ListedObject& object : result) object.cuboid = canonical(transformed(object.cuboid, X_TM, object.cuboid.frame));
  return result;
}

}  // namespace waretwin
