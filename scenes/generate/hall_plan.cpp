#include "scenes/generate/hall_plan.h"

#include <algorithm>
#include <cmath>

#include "core/pose.h"

namespace waretwin::generate {

Item make_item(std::function<void(builder::Kit&, int, const builder::Placement&)> add) {
  builder::Kit scratch;
  add(scratch, -1, {});
  return {std::move(add), scratch.model.bounds()};
}

double PlannedWall::yaw_deg() const { return to_degrees(std::atan2(to.y() - from.y(), to.x() - from.x())); }

builder::Placement PlannedWall::at(double along, double off, double z) const {
  const Eigen::Vector2d direction = (to - from).normalized(), inwards(-direction.y(), direction.x());
  const Eigen::Vector2d p = from + along * direction + off * inwards;
  return {p.x(), p.y(), z, yaw_deg()};
}

bool HallPlan::fits(const Solid& solid, double margin, bool may_take_free_space) const {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector2d corner =
          solid.centre + Eigen::Rotation2Dd(solid.yaw) * Eigen::Vector2d(sx * solid.half.x(), sy * solid.half.y());
      if (std::abs(corner.x()) > length / 2 - 0.005 || std::abs(corner.y()) > width / 2 - 0.005) return false;
    }
  }
  const auto met = [&](const Solid& other) { return collide(solid, other, margin); };
  if (std::any_of(solids.begin(), solids.end(), met)) return false;
  return may_take_free_space ||
         std::none_of(kept_free.begin(), kept_free.end(), [&](const Solid& zone) { return collide(solid, zone, 0.0); });
}

void HallPlan::add(const Item& item, const builder::Placement& at) {
  items.push_back({item, at});
  solids.push_back(solid_of(item.extent, at));
}

bool HallPlan::try_add(const Item& item, const builder::Placement& at, double margin) {
  if (!fits(solid_of(item.extent, at), margin)) return false;
  add(item, at);
  return true;
}

}  // namespace waretwin::generate
