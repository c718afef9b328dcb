// The vehicle as a body that rolls: a differential drive with two wheels and four sprung casters, steered along its route.
#pragma once

#include <array>

#include "scenes/scenario.h"
#include "sim/motion/bullet_world.h"
#include "sim/robot.h"

namespace waretwin {

// The vehicle's body as a box, clear of the floor: what it touches with.
struct Chassis {
  explicit Chassis(const RobotConfig& config);
  static constexpr double kFriction = 0.4;
  Eigen::Vector3d size, middle_B;
};

// A wheel is a place of the body where the contact with the floor moves: forward at omega * R less what the tyre gives way. With load N and
// traction T, both as Bullet's last step found them,
//   speed at the contact = omega * (R - (N - N0) / tyre stiffness) - |omega R| * T / (creep stiffness * N)
// (N0: the empty vehicle's share; linear creep below the grip limit: Pacejka, "Tyre and vehicle dynamics", 3rd ed., section 3.2, brush
// model). Coulomb friction holds the contact to that speed up to its limit; beyond it the wheel skids. Motors follow their speeds at once.
// Casters are springs with dampers and no friction. The body pitches and rolls a little on them, and every sensor with it.
class Drive {
 public:
  Drive(BulletWorld& world, const RobotConfig& config, const Pose& X_WB_start);

  // Before a step: sets the wheels' speeds from where the vehicle is and should be, as a driver would who sees both (feedback on position
  // and heading, after Kanayama et al., "A stable tracking control method for an autonomous mobile robot", ICRA 1990).
  void steer(const Pose& planned_X_WB, const Twist& planned);
  void after_step();

  Pose X_WB() const;
  Eigen::Quaterniond rotation_WB() const { return rotation_from_bullet(body_->getWorldTransform()); }  // unit; X_WB's is its matrix
  // What the wheels' turns say with the empty vehicle's radius and the track: pose since begin_reckoning in the frame O of where it stood
  // then.
  const Pose& reckoned_X_OB() const { return reckoned_X_OB_; }
  void begin_reckoning() { reckoned_X_OB_ = Pose::Identity(); }
  struct Wheel {
    double speed_mps = 0.0;   // omega * R
    double load_n = 0.0;      // smoothed
    double traction_n = 0.0;  // forward, smoothed
    double offset_y_m = 0.0;  // from the middle
  };
  const std::array<Wheel, 2>& wheels() const { return wheels_; }  // left, right

  // Called after each solve for what the body touches beside the floor, with the impulse in N s. Set before the first step.
  std::function<void(const Eigen::Vector3d& p_W, const BodyRole& other, int part, double impulse)> on_contact;

 private:
  void push_casters();
  double contact_speed(const Wheel& wheel) const;

  BulletWorld& world_;
  RobotConfig config_;
  Eigen::Vector3d centre_of_mass_B_;
  double empty_wheel_load_n_;
  BodyRole role_;
  btRigidBody* body_ = nullptr;
  std::array<Wheel, 2> wheels_;
  struct Sum {
    double load = 0.0, traction = 0.0;
  };
  std::array<Sum, 2> of_step_;
  Pose reckoned_X_OB_ = Pose::Identity();
};

}  // namespace waretwin
