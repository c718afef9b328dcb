#include "sim/motion/hall_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "core/digest.h"
#include "core/error.h"
#include "sim/motion/belts.h"
#include "sim/motion/drive.h"
#include "sim/motion/held.h"
#include "sim/motion/items.h"
#include "sim/motion/walkers.h"
#include "sim/robot.h"

namespace waretwin {

namespace {

constexpr double kKept_s = 1.5;  // how long places are kept beyond the longest turn of a laser: longer than any exposure
constexpr Stamp kSameContact = kNanosecondsPerSecond;
constexpr double kHallFriction = 0.6, kFloorFriction = 0.6;
// The vehicle's floor is the plane z = 0; what is lower than this belongs to it (marks, sills), what is higher than that is out of reach.
constexpr float kFloorHeight = 0.03f, kReach = 3.0f;
constexpr double kBefore_s = 0.1;  // physics begins at least this long before the drive, so that the first frame's exposure is in it

}  // namespace

void HallMoment::show(RayCaster& ray_caster) const {
  const Scene& scene = ray_caster.scene();
  WARETWIN_CHECK(movers.size() == scene.movers.size(), "a moment of this hall");
  ray_caster.set_shutter(begin, end);
  const auto put = [&](int index, const Place& place) {
    ray_caster.set_present(index, place.present);
    if (!place.present) return;
    const Eigen::Affine3f& X_GM = scene.instances[static_cast<std::size_t>(index)].X_WM;
    ray_caster.set_motion(index, place.X_WG_begin * X_GM, place.X_WG_end * X_GM);
  };
  for (std::size_t i = 0; i < movers.size(); ++i) {
    for (const int index : scene.movers[i].instances) put(index, movers[i]);
  }
  for (const int index : scene.vehicle) put(index, vehicle);
  ray_caster.commit();
}

struct HallMotion::State {
  State(const Scenario& a_scenario, RayCaster& ray_caster);

  Scenario scenario;
  RobotMotion plan;
  bool wheels;  // the drive model
  double kept_s = kKept_s;
  float reach_m = kReach;
  std::size_t mover_count;
  std::int64_t step = 0;  // number of the step to come; it ends at (step + 1) / step_hz. Step 0 begins with the drive
  BodyRole floor_role, hall_role, conveyor_role, robot_role;
  std::vector<std::string> hall_parts, conveyor_parts;  // names of nodes by part
  // Nothing that needs physics: none of these.
  std::unique_ptr<BulletWorld> world;
  std::unique_ptr<Belts> belts;
  std::unique_ptr<Items> items;
  std::unique_ptr<Walkers> walkers;
  std::unique_ptr<Drive> drive;
  btRigidBody* exact_robot = nullptr;

  struct Snapshot {
    std::int64_t step;  // that has just ended
    Pose reckoned_X_WB;
    struct Place {
      int stay = 0;  // 0 = not in the hall; another number is another item
      Pose X_WG = Pose::Identity();
    };
    std::vector<Place> movers;
  };
  std::deque<Snapshot> recent;
  // X_WB after each step of the drive, from stamp 0 on: kept for the whole drive, so as small as it can be without losing a bit.
  struct Driven {
    std::array<double, 3> p;
    std::array<double, 4> q;  // x, y, z, w; unit
    Pose X_WB() const {
      Pose X = Pose::Identity();
      X.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
      X.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
      return X;
    }
  };
  std::vector<Driven> driven;
  std::vector<RobotContact> contacts;
  struct Touch {  // of the last step, all points with one partner together
    std::string with;
    Eigen::Vector3d p_W;
    double force_n;
  };
  std::vector<Touch> touches;

  double time_of(std::int64_t number) const { return static_cast<double>(number) / scenario.motion.step_hz; }
  Stamp stamp_of(std::int64_t number) const { return from_seconds(time_of(number)); }
  Pose planned(double time_s) const { return plan.X_WB(from_seconds(std::max(time_s, 0.0))); }
  void add_hall(const RayCaster& ray_caster);
  void add_robot();
  void advance();
  void record();
  void note_touch(const Eigen::Vector3d& p_W, const std::string& with, double force);
  void note_contacts();
  std::string name_of(const BodyRole& other, int part) const;
  std::pair<const Snapshot*, const Snapshot*> around(Stamp stamp, double& share) const;
};

HallMotion::State::State(const Scenario& a_scenario, RayCaster& ray_caster)
    : scenario(a_scenario),
      plan(a_scenario.robot),
      wheels(a_scenario.robot.drive.model == "wheels"),
      mover_count(ray_caster.scene().movers.size()) {
  const MotionConfig& motion = scenario.motion;
  for (const Mover& mover : ray_caster.scene().movers) {
    for (const int instance : mover.instances) ray_caster.set_present(instance, false);
  }
  ray_caster.commit();
  if (!wheels && motion.empty()) return;
  for (const auto& [name, laser] : scenario.sensors.lasers) kept_s = std::max(kept_s, kKept_s + 1.0 / laser.rate_hz);
  double warm_up = motion.clutter.empty() ? kBefore_s : std::max(kBefore_s, motion.settle_s);
  for (const ItemStream& stream : motion.streams) {
    warm_up = std::max(warm_up, -stream.first_s);
    reach_m = std::max(reach_m, static_cast<float>(stream.z_m) + kReach);
  }
  for (const ClutterConfig& thing : motion.clutter) reach_m = std::max(reach_m, static_cast<float>(thing.z_m) + kReach);
  // The vehicle sinks into its casters.
  if (wheels) warm_up = std::max(warm_up, 0.5);
  step = -static_cast<std::int64_t>(std::ceil(warm_up * motion.step_hz));

  world = std::make_unique<BulletWorld>(1.0 / motion.step_hz);
  floor_role.group = BodyRole::kFloor;
  floor_role.name = "floor";
  floor_role.touched = [this](const Eigen::Vector3d&, const BodyRole& other, int, double, double) {
    if (other.group != BodyRole::kItem) return;
    Item& item = items->all()[static_cast<std::size_t>(other.index)];
    if (!item.touched_floor && !item.clutter) ++items->counts().fell_off;
    item.touched_floor = true;
  };
  world->add_floor(floor_role, kFloorFriction);
  belts = std::make_unique<Belts>(*world, ray_caster, motion);
  add_hall(ray_caster);
  items = std::make_unique<Items>(*world, ray_caster.scene(), motion, scenario.seed);
  walkers = std::make_unique<Walkers>(*world, ray_caster.scene(), motion, time_of(step));
  add_robot();
  items->drop_clutter();
  record();
}

// Triangles that the vehicle or an item can reach. The true objects that run as belts are apart: items meet their surfaces instead.
void HallMotion::State::add_hall(const RayCaster& ray_caster) {
  const Scene& scene = ray_caster.scene();
  const std::vector<bool> moves = scene.moves();
  std::vector<std::vector<Eigen::Vector3d>> hall, conveyors;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (moves[i]) continue;
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    std::vector<Eigen::Vector3d> part;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      Eigen::Vector3f corner[3];
      for (std::size_t k = 0; k < 3; ++k) corner[k] = instance.X_WM * mesh.positions[mesh.triangles[t + k]];
      const auto [low, high] = std::minmax({corner[0].z(), corner[1].z(), corner[2].z()});
      if (high < kFloorHeight || low > reach_m) continue;
      for (const Eigen::Vector3f& p : corner) part.push_back(p.cast<double>());
    }
    if (part.empty()) continue;
    const bool runs = instance.object >= 0 && belts->is_belt(instance.object);
    const std::string& name = instance.object >= 0 ? scene.objects[static_cast<std::size_t>(instance.object)].name : instance.name;
    (runs ? conveyors : hall).push_back(std::move(part));
    (runs ? conveyor_parts : hall_parts).push_back(name);
  }
  hall_role.group = BodyRole::kHall;
  hall_role.name = "hall";
  conveyor_role.group = BodyRole::kConveyor;
  conveyor_role.name = "conveyor";
  world->add_triangles(hall_role, hall, kHallFriction);
  world->add_triangles(conveyor_role, conveyors, kHallFriction);
}

void HallMotion::State::add_robot() {
  if (wheels) {
    drive = std::make_unique<Drive>(*world, scenario.robot, planned(0.0));
    drive->on_contact = [this](const Eigen::Vector3d& p_W, const BodyRole& other, int part, double impulse) {
      note_touch(p_W, name_of(other, part), impulse / world->step_s());
    };
    return;
  }
  // It follows its route whatever stands there; what can move gives way.
  robot_role.group = BodyRole::kRobot;
  robot_role.name = "robot";
  robot_role.touched = [this](const Eigen::Vector3d& p_W, const BodyRole& other, int part, double normal, double) {
    note_touch(p_W, name_of(other, part), normal / world->step_s());
  };
  const Chassis chassis(scenario.robot);
  btCompoundShape* shape = world->compound();
  Pose X_BS = Pose::Identity();
  X_BS.translation() = chassis.middle_B;
  shape->addChildShape(to_bullet(X_BS), world->box(chassis.size));
  exact_robot = world->add_body(robot_role, shape, planned(0.0), 0.0, Chassis::kFriction);
  world->make_kinematic(*exact_robot);
}

std::string HallMotion::State::name_of(const BodyRole& other, int part) const {
  const auto& parts = &other == &hall_role ? hall_parts : conveyor_parts;
  const bool in_parts = &other == &hall_role || &other == &conveyor_role;
  if (!in_parts || part < 0 || static_cast<std::size_t>(part) >= parts.size()) return other.name;
  const std::string& name = parts[static_cast<std::size_t>(part)];
  return name.empty() ? other.name : name;
}

void HallMotion::State::note_touch(const Eigen::Vector3d& p_W, const std::string& with, double force) {
  const auto known = std::find_if(touches.begin(), touches.end(), [&](const Touch& touch) { return touch.with == with; });
  if (known == touches.end()) {
    touches.push_back({with, p_W, force});
  } else {
    known->force_n += force;
  }
}

void HallMotion::State::note_contacts() {
  const Stamp now = stamp_of(step + 1);
  for (const Touch& touch : touches) {
    if (now < 0) break;
    const auto known = std::find_if(contacts.rbegin(), contacts.rend(), [&](const RobotContact& contact) {
      return contact.with == touch.with && now - contact.end <= kSameContact;
    });
    if (known == contacts.rend()) {
      contacts.push_back({now, now, touch.p_W, touch.with, touch.force_n});
    } else {
      known->end = now;
      known->force_n = std::max(known->force_n, touch.force_n);
    }
  }
  touches.clear();
}

void HallMotion::State::advance() {
  const double end_s = time_of(step + 1);
  belts->run(end_s, world->step_s());
  items->let_in(end_s);
  walkers->go_to(end_s);
  if (drive) {
    const Stamp at = from_seconds(end_s);
    drive->steer(planned(end_s), at > 0 ? plan.twist(at) : Twist{});
  } else {
    world->move_kinematic(*exact_robot, planned(end_s));
  }
  world->step();
  note_contacts();
  if (drive) drive->after_step();
  belts->measure(*items, world->step_s());
  items->take_out();
  ++step;
  record();
}

void HallMotion::State::record() {
  Snapshot now{.step = step, .reckoned_X_WB = Pose::Identity(), .movers = {}};
  for (const Item& item : items->all()) {
    now.movers.push_back(item.present ? Snapshot::Place{item.stay, item.X_WG()} : Snapshot::Place{});
  }
  for (std::size_t i = 0; i < walkers->count(); ++i) now.movers.push_back({1, walkers->X_WG(i, time_of(step))});
  for (const HeldConfig& thing : scenario.motion.held) {
    now.movers.push_back({1, held_X_WG(thing, time_of(step))});
    if (!thing.stand.empty()) now.movers.push_back({1, stand_X_WG(thing, time_of(step))});
  }
  WARETWIN_CHECK(now.movers.size() == mover_count, "every mover has a place");
  if (drive) {
    if (step == 0) drive->begin_reckoning();
    now.reckoned_X_WB = drive->reckoned_X_OB();
    if (step >= 0) {
      const Eigen::Vector3d p = drive->X_WB().translation();
      const Eigen::Quaterniond q = drive->rotation_WB();
      driven.push_back({{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}});
    }
  }
  recent.push_back(std::move(now));
  while (stamp_of(step) - stamp_of(recent.front().step) > from_seconds(kept_s)) recent.pop_front();
}

std::pair<const HallMotion::State::Snapshot*, const HallMotion::State::Snapshot*> HallMotion::State::around(Stamp stamp,
                                                                                                            double& share) const {
  WARETWIN_CHECK(!recent.empty() && stamp <= stamp_of(recent.back().step), "advance_to comes before the question");
  const auto after =
      std::lower_bound(recent.begin(), recent.end(), stamp, [this](const Snapshot& s, Stamp at) { return stamp_of(s.step) < at; });
  share = 0.0;
  if (after == recent.begin()) return {&*after, &*after};
  const auto before = after - 1;
  share = static_cast<double>(stamp - stamp_of(before->step)) / static_cast<double>(stamp_of(after->step) - stamp_of(before->step));
  return {&*before, &*after};
}

HallMotion::HallMotion(const Scenario& scenario, RayCaster& ray_caster) : state_(std::make_unique<State>(scenario, ray_caster)) {}
HallMotion::~HallMotion() = default;

void HallMotion::advance_to(Stamp stamp) {
  State& s = *state_;
  if (!s.world) return;
  while (s.stamp_of(s.step) < stamp) s.advance();
}

Pose HallMotion::X_WB(Stamp stamp) const {
  const State& s = *state_;
  if (!s.drive) return s.plan.X_WB(stamp);
  if (s.driven.empty()) return s.drive->X_WB();
  const double at = std::max(to_seconds(stamp), 0.0) * s.scenario.motion.step_hz;
  const auto before = static_cast<std::size_t>(std::floor(at));
  if (before + 1 >= s.driven.size()) return s.driven.back().X_WB();
  return interpolate(s.driven[before].X_WB(), s.driven[before + 1].X_WB(), at - static_cast<double>(before));
}

Pose HallMotion::wheels_X_WB(Stamp stamp) const {
  const State& s = *state_;
  if (!s.drive) return s.plan.X_WB(stamp);
  double share = 0.0;
  const auto [before, after] = s.around(std::max<Stamp>(stamp, 0), share);
  return s.plan.X_WB(0) * interpolate(before->reckoned_X_WB, after->reckoned_X_WB, share);
}

HallMoment HallMotion::moment(Stamp begin, Stamp end) const {
  const State& s = *state_;
  HallMoment moment{.begin = begin, .end = end, .movers = {}, .vehicle = {}};
  const auto placed = [this](Stamp stamp) { return Eigen::Affine3d(X_WB(stamp).matrix()).cast<float>(); };
  moment.vehicle = {true, placed(begin), placed(end)};
  if (s.mover_count == 0) return moment;
  double begin_share = 0.0, end_share = 0.0;
  const auto [b0, b1] = s.around(begin, begin_share);
  const auto [e0, e1] = s.around(end, end_share);
  for (std::size_t i = 0; i < s.mover_count; ++i) {
    HallMoment::Place place;
    // What comes or goes meanwhile is there when it is there at the end; before it came it stood where it came in.
    const int stay = e1->movers[i].stay;
    place.present = stay > 0;
    if (place.present) {
      const auto at = [i, stay](const State::Snapshot& a, const State::Snapshot& b, double share, const Pose& otherwise) {
        const bool in_a = a.movers[i].stay == stay, in_b = b.movers[i].stay == stay;
        if (in_a && in_b) return interpolate(a.movers[i].X_WG, b.movers[i].X_WG, share);
        return in_b ? b.movers[i].X_WG : otherwise;
      };
      const Pose last = at(*e0, *e1, end_share, Pose::Identity());
      place.X_WG_end = Eigen::Affine3d(last.matrix()).cast<float>();
      place.X_WG_begin = Eigen::Affine3d(at(*b0, *b1, begin_share, last).matrix()).cast<float>();
    }
    moment.movers.push_back(place);
  }
  return moment;
}

Stamp HallMotion::duration() const { return state_->plan.duration(); }
double HallMotion::distance_m() const { return state_->plan.distance_m(); }

MotionReport HallMotion::report() const {
  const State& s = *state_;
  MotionReport report;
  report.contacts = s.contacts;
  if (!s.world) return report;
  const ItemCounts& counts = s.items->counts();
  report.items_in = counts.came_in;
  report.items_delivered = counts.delivered;
  report.items_in_hall = counts.in_hall;
  report.items_fell_off = counts.fell_off;
  report.items_fell_through = counts.fell_through;
  report.items_waited = counts.waited;
  for (const Belt& belt : s.belts->all()) {
    BeltReport entry;
    entry.name = belt.surface.name;
    entry.wanted_mps = belt.wanted_speed(s.time_of(s.step));
    if (belt.samples > 0) {
      entry.mean_ratio = belt.ratio_sum / static_cast<double>(belt.samples);
      entry.worst_ratio = belt.worst_ride;
    }
    entry.carried_s = static_cast<double>(belt.samples) * s.world->step_s();
    report.belts.push_back(entry);
  }
  return report;
}

std::string HallMotion::digest() const {
  const State& s = *state_;
  Digest digest;
  const auto add = [&digest](const Pose& X) {
    const Eigen::Matrix4d m = X.matrix();
    digest.add_bytes(m.data(), 16 * sizeof(double));
  };
  digest.add(s.step);
  if (s.drive) add(s.drive->X_WB());
  if (!s.recent.empty()) {
    for (const auto& place : s.recent.back().movers) {
      digest.add(place.stay);
      add(place.X_WG);
    }
  }
  return digest.hex();
}

}  // namespace waretwin
