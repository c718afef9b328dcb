#include "sim/motion/walkers.h"

#include <cmath>

#include "sim/motion/held.h"
#include "sim/motion/items.h"

namespace waretwin {

namespace {

RobotConfig way_of(const WalkerConfig& config) {
  RobotConfig way;
  way.speed_mps = config.speed_mps;
  way.acceleration_mps2 = config.acceleration_mps2;
  way.turn_rate_deg_s = config.turn_rate_deg_s;
  way.turn_acceleration_deg_s2 = config.turn_acceleration_deg_s2;
  way.route = config.path;
  if (config.loop && way.route.size() > 1) {
    // Back to where it began, as it stood there.
    Waypoint first = config.path.front();
    first.wait_s = 0.0;
    if (!first.heading_deg) first.heading_deg = to_degrees(yaw_of(RobotMotion(way).X_WB(0)));
    way.route.push_back(first);
  }
  return way;
}

}  // namespace

Walkers::Walkers(BulletWorld& world, const Scene& scene, const MotionConfig& config, double time_s) : world_(world) {
  const std::size_t first = scene.movers.size() - held_mover_count(config) - config.walkers.size();
  for (std::size_t i = 0; i < config.walkers.size(); ++i) {
    const Mover& mover = scene.movers[first + i];
    walkers_.push_back({.config = config.walkers[i], .way = RobotMotion(way_of(config.walkers[i])), .role = {}, .body = nullptr});
    Walker& walker = walkers_.back();
    walker.role.group = BodyRole::kWalker;
    walker.role.name = mover.name;
    // Walkers and the floor do not meet, so feet may stand in it.
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : vertices_G(scene, mover)) box.extend(p);
    btCompoundShape* shape = world.compound();
    Pose X_GS = Pose::Identity();
    X_GS.translation() = box.center();
    shape->addChildShape(to_bullet(X_GS), world.box(box.sizes().cwiseMax(0.01)));
    walker.body = world.add_body(walker.role, shape, X_WG(i, time_s), 0.0, 0.5);
    world.make_kinematic(*walker.body);
  }
}

Pose Walkers::X_WG(std::size_t index, double time_s) const {
  const Walker& walker = walkers_[index];
  double on_way = time_s - walker.config.start_s;
  const double round = to_seconds(walker.way.duration());
  if (walker.config.loop && round > 0.0 && on_way > 0.0) on_way = std::fmod(on_way, round);
  return walker.way.X_WB(from_seconds(std::max(on_way, 0.0)));
}

void Walkers::go_to(double time_s) {
  for (std::size_t i = 0; i < walkers_.size(); ++i) world_.move_kinematic(*walkers_[i].body, X_WG(i, time_s));
}

}  // namespace waretwin
