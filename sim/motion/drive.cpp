#include "sim/motion/drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace waretwin {

namespace {

constexpr double kGravity = 9.81;
// The body's underside. What is lower than scenes' floors are taken to be (3 cm) passes below.
constexpr double kClearance = 0.05;
// Casters, as shares of half the body's length and width, and how far they are pressed in by the empty vehicle.
constexpr double kCasterAlong = 0.85, kCasterAcross = 0.75, kCasterTravel = 0.002, kCasterDamping = 0.9;
// Loads and tractions are smoothed over about ten steps: the solver shares them out anew each step.
constexpr double kSmoothing = 0.1;
constexpr double kMostCreep = 0.5;
// Feedback of the driver: 1/s, 1/s, 1/m per m/s.
constexpr double kAlongGain = 2.0, kHeadingGain = 4.0, kSideGain = 8.0;

}  // namespace

Chassis::Chassis(const RobotConfig& config) {
  const double gap = std::min(kClearance, 0.5 * config.height_m);
  size = {config.length_m, config.width_m, config.height_m - gap};
  middle_B = {0.0, 0.0, 0.5 * (config.height_m + gap)};
}

Drive::Drive(BulletWorld& world, const RobotConfig& config, const Pose& X_WB_start) : world_(world), config_(config) {
  const DriveConfig& d = config.drive;
  const double mass = d.mass_kg + d.payload_kg;
  const Eigen::Vector3d payload(d.payload_x_m, d.payload_y_m, d.payload_z_m);
  const Eigen::Vector3d base(0, 0, 0.5 * config.height_m);
  centre_of_mass_B_ = (d.mass_kg * base + d.payload_kg * payload) / mass;
  empty_wheel_load_n_ = 0.5 * (1.0 - d.caster_share) * d.mass_kg * kGravity;

  role_.group = BodyRole::kRobot;
  role_.name = "robot";
  const auto side_of = [this](const Eigen::Vector3d& p_W) -> std::size_t { return (X_WB().inverse() * p_W).y() > 0.0 ? 0 : 1; };
  role_.surface = [this, side_of](const Eigen::Vector3d& p_W, const BodyRole& other, SurfaceMotion& motion) {
    if (other.group != BodyRole::kFloor) return false;
    motion.direction_W = X_WB().linear().col(0);
    motion.speed = -contact_speed(wheels_[side_of(p_W)]);  // of the floor as the wheel sees it
    motion.friction = config_.drive.floor_friction;
    return true;
  };

  role_.touched = [this, side_of](const Eigen::Vector3d& p_W, const BodyRole& other, int part, double normal, double along) {
    if (other.group != BodyRole::kFloor) {
      if (on_contact) on_contact(p_W, other, part, normal);
      return;
    }
    Sum& sum = of_step_[side_of(p_W)];
    sum.load += normal;
    sum.traction -= along;  // the wheel pushes the floor back
  };

  btCompoundShape* shape = world.compound();
  const auto add = [&](btCollisionShape* part, const Eigen::Vector3d& p_B) {
    Pose X = Pose::Identity();
    X.translation() = p_B - centre_of_mass_B_;
    shape->addChildShape(to_bullet(X), part);
  };
  const Chassis chassis(config);
  add(world.box(chassis.size), chassis.middle_B);
  for (std::size_t i = 0; i < 2; ++i) {
    wheels_[i].offset_y_m = (i == 0 ? 0.5 : -0.5) * d.track_m;
    wheels_[i].load_n = empty_wheel_load_n_;
    add(world.sphere(d.wheel_radius_m), {0, wheels_[i].offset_y_m, d.wheel_radius_m});
  }
  Pose X_WS = X_WB_start;
  X_WS.translation() += X_WB_start.linear() * centre_of_mass_B_;
  body_ = world.add_body(role_, shape, X_WS, mass, Chassis::kFriction);
  // A solid box and a point, about their common centre.
  const auto squares = [](const Eigen::Vector3d& v) {
    return Eigen::Vector3d(v.y() * v.y() + v.z() * v.z(), v.x() * v.x() + v.z() * v.z(), v.x() * v.x() + v.y() * v.y());
  };
  const Eigen::Vector3d inertia =
      d.mass_kg * (squares({config.length_m, config.width_m, config.height_m}) / 12.0 + squares(base - centre_of_mass_B_)) +
      d.payload_kg * squares(payload - centre_of_mass_B_);
  body_->setMassProps(mass, to_bullet(inertia));
  body_->updateInertiaTensor();
  body_->setActivationState(DISABLE_DEACTIVATION);
}

double Drive::contact_speed(const Wheel& wheel) const {
  const DriveConfig& d = config_.drive;
  const double flattened = (wheel.load_n - empty_wheel_load_n_) / d.tyre_stiffness_n_m;
  const double rolling = wheel.speed_mps * (1.0 - flattened / d.wheel_radius_m);
  const double creep = wheel.traction_n / (d.creep_stiffness * std::max(wheel.load_n, 1.0));
  return rolling - std::abs(wheel.speed_mps) * std::clamp(creep, -kMostCreep, kMostCreep);
}

void Drive::push_casters() {
  const DriveConfig& d = config_.drive;
  const double preload = 0.25 * d.caster_share * d.mass_kg * kGravity;
  const double stiffness = preload / kCasterTravel;
  const double damping = kCasterDamping * 2.0 * std::sqrt(stiffness * 0.25 * d.mass_kg);
  const Pose X = X_WB();
  const Eigen::Vector3d centre_W = X * centre_of_mass_B_;
  // All are measured before the first one pushes.
  std::array<std::pair<btVector3, double>, 4> pushes;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    const double x = i % 2 == 0 ? -0.5 : 0.5, y = i / 2 == 0 ? -0.5 : 0.5;
    const Eigen::Vector3d foot_W = X * Eigen::Vector3d(x * kCasterAlong * config_.length_m, y * kCasterAcross * config_.width_m, 0.0);
    const btVector3 arm = to_bullet(Eigen::Vector3d(foot_W - centre_W));
    const double rise = body_->getVelocityInLocalPoint(arm).z();
    pushes[i] = {arm, std::max(preload - stiffness * foot_W.z() - damping * rise, 0.0)};
  }
  // As impulses: Bullet's friction overlooks the torque of forces.
  for (const auto& [arm, force] : pushes) body_->applyImpulse({0, 0, force * world_.step_s()}, arm);
}

void Drive::steer(const Pose& planned_X_WB, const Twist& planned) {
  const Pose X = X_WB();
  const double yaw = yaw_of(X);
  const Eigen::Vector2d off = Eigen::Rotation2Dd(-yaw) * (planned_X_WB.translation() - X.translation()).head<2>();
  const double turned_off = wrap_angle(yaw_of(planned_X_WB) - yaw);
  const double forward = planned.forward_mps * std::cos(turned_off) + kAlongGain * off.x();
  const double turn = planned.turn_rad_s + kHeadingGain * turned_off + kSideGain * planned.forward_mps * off.y();
  for (Wheel& wheel : wheels_) wheel.speed_mps = forward - turn * wheel.offset_y_m;
  push_casters();
  of_step_ = {};
}

void Drive::after_step() {
  const double dt = world_.step_s();
  for (std::size_t i = 0; i < 2; ++i) {
    wheels_[i].load_n += kSmoothing * (of_step_[i].load / dt - wheels_[i].load_n);
    wheels_[i].traction_n += kSmoothing * (of_step_[i].traction / dt - wheels_[i].traction_n);
  }
  const double forward = 0.5 * (wheels_[0].speed_mps + wheels_[1].speed_mps) * dt;
  const double turn = (wheels_[1].speed_mps - wheels_[0].speed_mps) / config_.drive.track_m * dt;
  // Halfway through the turn is the direction of the step.
  reckoned_X_OB_ = reckoned_X_OB_ * make_upright_pose(forward * std::cos(0.5 * turn), forward * std::sin(0.5 * turn), 0.0, turn);
}

Pose Drive::X_WB() const {
  Pose X = from_bullet(body_->getWorldTransform());
  X.translation() -= X.linear() * centre_of_mass_B_;
  return X;
}

}  // namespace waretwin
