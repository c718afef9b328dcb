#include "sim/motion/items.h"

#include <algorithm>
#include <numbers>

#include "core/random.h"

namespace waretwin {

namespace {

// Layers in which clutter falls, so that nothing begins inside something else.
constexpr double kLayer_m = 0.03;
constexpr double kLinearDamping = 0.01, kAngularDamping = 0.05;

}  // namespace

std::vector<Eigen::Vector3d> vertices_G(const Scene& scene, const Mover& mover) {
  std::vector<Eigen::Vector3d> points;
  for (const int index : mover.instances) {
    const Instance& instance = scene.instances[static_cast<std::size_t>(index)];
    for (const Eigen::Vector3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
      points.push_back((instance.X_WM * p).cast<double>());
    }
  }
  return points;
}

Items::Items(BulletWorld& world, const Scene& scene, const MotionConfig& config, std::uint64_t seed)
    : world_(world), config_(config), seed_(seed) {
  std::size_t mover = 0;
  for (const ItemStream& stream : config.streams) {
    streams_.push_back({.config = stream, .first = items_.size(), .due_s = stream.first_s});
    for (int i = 0; i < stream.most; ++i, ++mover) make(scene, mover, scene.movers[mover].name, stream.body);
  }
  first_clutter_ = items_.size();
  for (const ClutterConfig& thing : config.clutter) {
    for (int i = 0; i < thing.count; ++i, ++mover) {
      make(scene, mover, scene.movers[mover].name, thing.body);
      items_.back().clutter = true;
    }
  }
}

void Items::make(const Scene& scene, std::size_t mover, const std::string& name, const ItemBody& body) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : vertices_G(scene, scene.movers[mover])) box.extend(p);
  Item& item = items_.emplace_back();
  item.role.group = BodyRole::kItem;
  item.role.name = name;
  item.role.index = static_cast<int>(items_.size()) - 1;
  item.X_GS.translation() = box.center();
  const Eigen::Vector3d size = box.sizes().cwiseMax(0.002);
  item.body = world_.add_body(item.role, world_.box(size), item.X_GS, body.mass_kg, body.friction);
  item.body->setDamping(kLinearDamping, kAngularDamping);
  world_.take_out(*item.body);
}

void Items::drop_clutter() {
  std::size_t index = first_clutter_;
  for (const ClutterConfig& thing : config_.clutter) {
    const RandomStream random(thing.seed, thing.name.empty() ? thing.body.file.stem().string() : thing.name, "clutter");
    double height = thing.z_m;
    for (int i = 0; i < thing.count; ++i, ++index) {
      Item& item = items_[index];
      const auto draw = [&](std::uint64_t k, double spread) {
        return spread * (2.0 * static_cast<double>(random.uniform(static_cast<std::uint64_t>(i), k)) - 1.0);
      };
      const Eigen::Quaterniond turn = Eigen::AngleAxisd(draw(0, std::numbers::pi), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(draw(1, 0.5 * std::numbers::pi), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(draw(2, std::numbers::pi), Eigen::Vector3d::UnitX());
      Pose X_WG = Pose::Identity();
      X_WG.linear() = turn.toRotationMatrix();
      X_WG.translation() = Eigen::Vector3d(thing.x_m + draw(3, thing.spread_x_m), thing.y_m + draw(4, thing.spread_y_m), height);
      while (world_.would_touch(*item.body, X_WG * item.X_GS, BodyRole::kItem | BodyRole::kWalker | BodyRole::kRobot))
        X_WG.translation().z() += kLayer_m;
      height = X_WG.translation().z();
      world_.put_in(*item.body, X_WG * item.X_GS);
      item.begin_stay();
    }
  }
}

Pose Items::next_place(const Stream& stream) const {
  const ItemStream& config = stream.config;
  const RandomStream random(seed_, config.name.empty() ? config.body.file.stem().string() : config.name, "item_stream");
  const auto draw = [&](std::uint64_t k) { return 2.0 * static_cast<double>(random.uniform(stream.number, k)) - 1.0; };
  const double yaw = to_radians(config.yaw_deg), side = config.side_spread_m * draw(0);
  return make_upright_pose(config.x_m - side * std::sin(yaw), config.y_m + side * std::cos(yaw), config.z_m,
                           yaw + to_radians(config.yaw_spread_deg) * draw(1));
}

void Items::let_in(double time_s) {
  for (Stream& stream : streams_) {
    if (time_s < stream.due_s) continue;
    const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(stream.first), end = begin + stream.config.most;
    const auto item = std::find_if(begin, end, [](const Item& i) { return !i.present; });
    if (item == end) continue;  // all are in the hall
    const Pose X_WS = next_place(stream) * item->X_GS;
    if (world_.would_touch(*item->body, X_WS, BodyRole::kItem | BodyRole::kWalker | BodyRole::kRobot)) {
      if (!stream.waiting) ++counts_.waited;
      stream.waiting = true;
      continue;
    }
    world_.put_in(*item->body, X_WS);
    // What a belt carries must not fall asleep while the belt stands.
    item->body->setActivationState(DISABLE_DEACTIVATION);
    item->begin_stay();
    ++counts_.came_in;
    ++counts_.in_hall;
    ++stream.number;
    stream.waiting = false;
    // One that came late keeps its distance from the next.
    const bool late = time_s - stream.due_s > 0.1 * stream.config.every_s;
    stream.due_s = (late ? time_s : stream.due_s) + stream.config.every_s;
  }
}

void Items::take_out() {
  for (Item& item : items_) {
    if (!item.present || item.clutter) continue;
    const Eigen::Vector3d p = item.middle();
    for (const ItemSink& sink : config_.sinks) {
      const Eigen::Array3d off(p.x() - sink.x_m, p.y() - sink.y_m, p.z() - sink.z_m);
      if (!(off.abs() <= 0.5 * Eigen::Array3d(sink.size_x_m, sink.size_y_m, sink.size_z_m)).all()) continue;
      world_.take_out(*item.body);
      item.present = false;
      --counts_.in_hall;
      ++counts_.delivered;
      break;
    }
  }
}

}  // namespace waretwin
