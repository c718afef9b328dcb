// The one place that steps Bullet: rigid bodies in double precision at fixed steps, running surfaces and wheels as contacts that move.
// Inside sim/motion/ only; hall_motion.h is what others see.
//
// A surface that carries (a belt) or rolls (a wheel) stands still as a shape; its motion is that of its contacts: before each solve every
// contact point gets the speed at which the two surfaces are to pass each other, and Coulomb friction brings them there as far as the load
// allows. So belts never bump at seams and wheels skid when they must.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/pose.h"
#include "scenes/scene.h"

namespace waretwin {

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btTransform to_bullet(const Pose& X);
Pose from_bullet(const btTransform& X);
Eigen::Quaterniond rotation_from_bullet(const btTransform& X);  // unit; from_bullet's is its matrix

// How a contact point is to slide, seen from the body that carries the role.
struct SurfaceMotion {
  Eigen::Vector3d direction_W;  // unit, in the plane of the contact
  double speed = 0.0;           // of the other body relative to this one along the direction
  double friction = 0.5;        // in place of the two bodies' own
  bool level = false;           // the contact's normal is vertical, whatever the shapes say (seams of a running surface)
};

// What a body is to the others. Owned by whoever made the body; outlives the world's use of it.
struct BodyRole {
  enum Group { kFloor = 1, kHall = 2, kConveyor = 4, kBelt = 8, kItem = 16, kWalker = 32, kRobot = 64 };
  Group group = kHall;
  std::string name;
  int index = -1;  // among its kind, where that matters to its maker
  // Called for each contact of this body with another at the point p_W; false: an ordinary contact.
  std::function<bool(const Eigen::Vector3d& p_W, const BodyRole& other, SurfaceMotion& motion)> surface;
  // Called after each solve with the impulses (N s) along the normal (towards this body) and along SurfaceMotion::direction_W (what the
  // surface exerts on the other body), and the other body. `part` is the index of the hall's mesh where the other is the hall.
  std::function<void(const Eigen::Vector3d& p_W, const BodyRole& other, int part, double normal, double along)> touched;
};

class BulletWorld {
 public:
  explicit BulletWorld(double step_s);
  ~BulletWorld();
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  double step_s() const { return step_s_; }
  void step();

  // The infinite floor z = 0.
  void add_floor(BodyRole& role, double friction);
  // Triangles that stand still, in the world frame; a contact names its part by its index. No part is empty.
  void add_triangles(BodyRole& role, const std::vector<std::vector<Eigen::Vector3d>>& parts, double friction);
  // Shapes are kept by the world. Boxes by their full size; hulls by their points.
  btCollisionShape* box(const Eigen::Vector3d& size);
  btCollisionShape* hull(const std::vector<Eigen::Vector3d>& points);
  btCollisionShape* sphere(double radius);
  btCompoundShape* compound();
  // mass 0: stands still, or is moved (make_kinematic). X_WS: the shape's frame, which for moving bodies is that of the centre of mass.
  btRigidBody* add_body(BodyRole& role, btCollisionShape* shape, const Pose& X_WS, double mass, double friction);
  void make_kinematic(btRigidBody& body);
  void move_kinematic(btRigidBody& body, const Pose& X_WS);  // where it is to be after the next step
  // Bodies outside the world neither move nor touch.
  void take_out(btRigidBody& body);
  void put_in(btRigidBody& body, const Pose& X_WS);
  // Whether the body, put at X_WS, would touch one of these groups. The body is outside the world.
  bool would_touch(btRigidBody& body, const Pose& X_WS, int groups);

  static BodyRole& role_of(const btCollisionObject& body) { return *static_cast<BodyRole*>(body.getUserPointer()); }

 private:
  void add_triangles(BodyRole& role, std::span<const std::vector<Eigen::Vector3d>> parts, double friction, int first);
  struct World;
  double step_s_;
  std::unique_ptr<World> world_;
};

}  // namespace waretwin
