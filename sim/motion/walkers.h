// People and vehicles that go their way whatever stands there.
#pragma once

#include <deque>
#include <vector>

#include "scenes/scenario.h"
#include "sim/motion/bullet_world.h"
#include "sim/robot.h"

namespace waretwin {

class Walkers {
 public:
  // Their movers stand in the scene before those of held things, which are the last.
  Walkers(BulletWorld& world, const Scene& scene, const MotionConfig& config, double time_s);

  std::size_t count() const { return walkers_.size(); }
  // In closed form.
  Pose X_WG(std::size_t index, double time_s) const;
  void go_to(double time_s);  // before the step that ends then

 private:
  struct Walker {
    WalkerConfig config;
    RobotMotion way;
    BodyRole role;
    btRigidBody* body = nullptr;
  };
  BulletWorld& world_;
  std::deque<Walker> walkers_;  // keeps addresses
};

}  // namespace waretwin
