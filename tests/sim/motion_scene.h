// Halls with things that move, made of boxes.
#pragma once

#include <memory>
#include <string>

#include "scenes/scenario.h"
#include "sim/ray_caster.h"
#include "tests/sim/fixtures.h"

namespace waretwin::fixtures {

// A floor of 40 x 40 m and what a test puts on it. Movers must be added in the order of Scene::movers.
class MotionScene {
 public:
  MotionScene() {
    white_ = add_material(scene_, {0.8f, 0.8f, 0.8f});
    box_ = add_mesh(scene_, unit_box(), white_);
    add_instance(scene_, box_, placed({-20, -20, -1}, {40, 40, 1}));
    scenario.name = "motion";
    scenario.sensors = {};
    Waypoint start;
    start.x_m = -15.0;
    start.y_m = -15.0;
    scenario.robot.route = {start};
    scenario.robot.drive.model = "exact";
  }

  // An upright box that stands still; its lower corner before it is turned about it.
  int add_box(const Eigen::Vector3f& low, const Eigen::Vector3f& size, int object = -1, float yaw = 0.0f, const std::string& name = {}) {
    const int instance = add_instance(scene_, box_, placed(low, size, yaw), object);
    if (!name.empty()) scene_.instances.back().name = name;
    return instance;
  }

  // A straight conveyor as a true object, its strip from (x, y) along yaw: a deck of its width with rails beside it.
  void add_conveyor(const std::string& name, double x, double y, double yaw, double length, double width, double top, double rail) {
    const int object = waretwin::fixtures::add_object(scene_, "conveyor");
    TrueObject& truth = scene_.objects.back();
    truth.name = name;
    truth.cuboid.yaw = yaw;
    const Eigen::Rotation2Dd turn(yaw);
    const auto part = [&](double side, double part_width, double low, double high) {
      const Eigen::Vector2d corner = Eigen::Vector2d(x, y) + turn * Eigen::Vector2d(0.0, side);
      add_box(Eigen::Vector3d(corner.x(), corner.y(), low).cast<float>(), Eigen::Vector3d(length, part_width, high - low).cast<float>(),
              object, static_cast<float>(yaw));
    };
    part(-0.5 * width, width, top - 0.1, top);
    if (rail > 0.0) {
      part(-0.5 * width - 0.04, 0.04, top - 0.1, top + rail);
      part(0.5 * width, 0.04, top - 0.1, top + rail);
    }
  }

  // A mover that is a box standing on its frame's origin.
  void add_mover(const std::string& name, const Eigen::Vector3f& size) {
    Mover mover;
    mover.name = name;
    mover.instances.push_back(add_box({-0.5f * size.x(), -0.5f * size.y(), 0.0f}, size));
    scene_.movers.push_back(mover);
  }

  std::unique_ptr<RayCaster> caster() const { return std::make_unique<RayCaster>(std::make_shared<const Scene>(scene_)); }

  Scenario scenario;

 private:
  Scene scene_;
  int white_ = 0, box_ = 0;
};

}  // namespace waretwin::fixtures
