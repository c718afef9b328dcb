#include "sim/motion/belts.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace waretwin {

namespace {

constexpr double kThickness = 0.12, kGuardThickness = 0.03, kGuardDepth = 0.05;
constexpr double kGuardFriction = 0.05;  // smooth rails: they guide, they don't brake
constexpr double kArcStep = 0.1;         // radians an arc's pieces turn at most
constexpr double kSteady_s = 0.5;
constexpr double kShortestRide = 60;  // samples; shorter ones say nothing

// A piece of the strip between two places along and two across it, from z0 to z1.
void add_pieces(BulletWorld& world, BodyRole& role, const BeltSurface& surface, double right, double left, double z0, double z1,
                double friction) {
  const int pieces = surface.curve ? std::max(1, static_cast<int>(std::ceil(surface.length / surface.radius / kArcStep))) : 1;
  for (int i = 0; i < pieces; ++i) {
    std::vector<Eigen::Vector3d> corners;
    for (const double along : {surface.length * i / pieces, surface.length * (i + 1) / pieces}) {
      for (const double side : {right, left}) {
        const Eigen::Vector2d p = surface.point(along, side);
        for (const double z : {z0, z1}) corners.emplace_back(p.x(), p.y(), z);
      }
    }
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : corners) middle += p / static_cast<double>(corners.size());
    for (Eigen::Vector3d& p : corners) p -= middle;
    Pose X = Pose::Identity();
    X.translation() = middle;
    world.add_body(role, world.hull(corners), X, 0.0, friction);
  }
}

}  // namespace

double Belt::wanted_speed(double time_s) const {
  double speed = config.speed_mps;
  for (const BeltChange& change : config.changes) {
    if (time_s >= change.at_s) speed = change.speed_mps;
  }
  return speed;
}

Belts::Belts(BulletWorld& world, const RayCaster& ray_caster, const MotionConfig& config) {
  for (std::size_t i = 0; i < config.belts.size(); ++i) {
    for (BeltSurface& surface : find_belt_surfaces(ray_caster, config.belts[i], i)) {
      if (is_belt(surface.object)) {
        throw Error("motion.belts." + std::to_string(i) + ".object '" + config.belts[i].object + "' matches '" + surface.name +
                    "', which an earlier belt names already");
      }
      Belt& belt = belts_.emplace_back();
      belt.surface = std::move(surface);
      belt.config = config.belts[i];
      add_bodies(world, belt, static_cast<int>(belts_.size()) - 1);
    }
  }
}

void Belts::add_bodies(BulletWorld& world, Belt& belt, int index) {
  const BeltSurface& s = belt.surface;
  belt.role.group = belt.guard_role.group = BodyRole::kBelt;
  belt.role.name = s.name;
  belt.guard_role.name = s.name + " guard";
  belt.role.surface = [&belt](const Eigen::Vector3d& p_W, const BodyRole&, SurfaceMotion& motion) {
    // What touches its sides is no passenger.
    if (p_W.z() < belt.surface.top - kGuardDepth) return false;
    const Eigen::Vector2d travel = belt.surface.travel(p_W.head<2>());
    motion.direction_W = {travel.x(), travel.y(), 0.0};
    motion.speed = belt.speed_mps * belt.surface.speed_factor(p_W.head<2>());
    motion.friction = belt.config.friction;
    motion.level = true;
    return true;
  };
  belt.role.touched = [this, index](const Eigen::Vector3d&, const BodyRole& other, int, double, double) {
    if (other.group == BodyRole::kItem) carried_.emplace_back(other.index, index);
  };
  add_pieces(world, belt.role, s, s.right, s.left, s.top - kThickness, s.top, belt.config.friction);
  if (s.left_guard > 0.0) {
    add_pieces(world, belt.guard_role, s, s.left, s.left + kGuardThickness, s.top - kGuardDepth, s.top + s.left_guard, kGuardFriction);
  }
  if (s.right_guard > 0.0) {
    add_pieces(world, belt.guard_role, s, s.right - kGuardThickness, s.right, s.top - kGuardDepth, s.top + s.right_guard, kGuardFriction);
  }
}

void Belts::run(double time_s, double step_s) {
  for (Belt& belt : belts_) {
    const double wanted = belt.wanted_speed(time_s), most = belt.config.acceleration_mps2 * step_s;
    const double change = std::clamp(wanted - belt.speed_mps, -most, most);
    belt.speed_mps += change;
    belt.steady_s = change == 0.0 ? belt.steady_s + step_s : 0.0;
  }
}

void Belts::end_ride(Item& item) {
  if (static_cast<double>(item.ride_samples) >= kShortestRide) {
    const double mean = item.ride_sum / static_cast<double>(item.ride_samples);
    Belt& belt = belts_[static_cast<std::size_t>(item.belt)];
    if (std::abs(mean - 1.0) > std::abs(belt.worst_ride - 1.0)) belt.worst_ride = mean;
  }
  item.ride_sum = 0.0;
  item.ride_samples = 0;
}

void Belts::measure(Items& items, double step_s) {
  std::sort(carried_.begin(), carried_.end());
  carried_.erase(std::unique(carried_.begin(), carried_.end()), carried_.end());
  auto next = carried_.begin();
  for (Item& item : items.all()) {
    const auto first = std::find_if(next, carried_.end(), [&](const auto& pair) { return pair.first >= item.role.index; });
    next = std::find_if(first, carried_.end(), [&](const auto& pair) { return pair.first > item.role.index; });
    if (!item.present) {
      end_ride(item);
      continue;
    }
    const bool alone = next - first == 1 && first->second == item.belt;
    if (!alone) end_ride(item);
    item.alone_s = alone ? item.alone_s + step_s : 0.0;
    if (first != next && item.belt != first->second) {
      item.belt = first->second;
      // A belt that starts must find awake what lay on it while it stood.
      item.body->setActivationState(DISABLE_DEACTIVATION);
    }
    if (item.belt < 0) continue;
    Belt& belt = belts_[static_cast<std::size_t>(item.belt)];
    const Eigen::Vector3d p = item.middle();
    if (!belt.surface.carries(p.head<2>())) continue;
    if (!item.touched_floor && p.z() < belt.surface.top - kGuardDepth) {
      items.counts().fell_through += item.fell_through ? 0 : 1;
      item.fell_through = true;
      end_ride(item);
      item.belt = -1;
      continue;
    }
    const double surface_speed = belt.speed_mps * belt.surface.speed_factor(p.head<2>());
    if (!(item.alone_s > kSteady_s && belt.steady_s > kSteady_s && std::abs(surface_speed) > 0.01)) {
      end_ride(item);
      continue;
    }
    const double ratio = from_bullet(item.body->getLinearVelocity()).head<2>().dot(belt.surface.travel(p.head<2>())) / surface_speed;
    item.ride_sum += ratio;
    ++item.ride_samples;
    belt.ratio_sum += ratio;
    ++belt.samples;
  }
  carried_.clear();
}

bool Belts::is_belt(int object) const {
  return std::any_of(belts_.begin(), belts_.end(), [object](const Belt& belt) { return belt.surface.object == object; });
}

}  // namespace waretwin
