#include "sim/motion/bullet_world.h"

#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

constexpr double kGravity = 9.81;

// Whom each group can touch. The hall, conveyors, belts and the floor stand still; walkers go their way.
int partners(BodyRole::Group group) {
  switch (group) {
    case BodyRole::kFloor:
      return BodyRole::kItem | BodyRole::kRobot;
    case BodyRole::kHall:
      return BodyRole::kItem | BodyRole::kRobot;
    case BodyRole::kConveyor:
      return BodyRole::kRobot;  // items meet its running surface and guards instead of its triangles
    case BodyRole::kBelt:
      return BodyRole::kItem;
    case BodyRole::kItem:
      return BodyRole::kFloor | BodyRole::kHall | BodyRole::kBelt | BodyRole::kItem | BodyRole::kWalker | BodyRole::kRobot;
    case BodyRole::kWalker:
      return BodyRole::kItem | BodyRole::kRobot;
    case BodyRole::kRobot:
      return BodyRole::kFloor | BodyRole::kHall | BodyRole::kConveyor | BodyRole::kItem | BodyRole::kWalker;
  }
  return 0;
}

// Contact points get their surface motion after they are found and before they are solved.
class SurfaceMovingWorld final : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;

  void report_touches() {
    for (int m = 0; m < getDispatcher()->getNumManifolds(); ++m) {
      const btPersistentManifold* manifold = getDispatcher()->getManifoldByIndexInternal(m);
      const BodyRole& role0 = BulletWorld::role_of(*manifold->getBody0());
      const BodyRole& role1 = BulletWorld::role_of(*manifold->getBody1());
      if (!role0.touched && !role1.touched) continue;
      for (int i = 0; i < manifold->getNumContacts(); ++i) {
        const btManifoldPoint& point = manifold->getContactPoint(i);
        if (!(point.m_appliedImpulse > 0.0)) continue;
        const Eigen::Vector3d p_W = from_bullet(point.getPositionWorldOnB());
        // Impulses of the first tangent act on body 0 along it and on body 1 against it.
        if (role0.touched)
          role0.touched(p_W, role1, part_of(*manifold->getBody1(), point.m_partId1), point.m_appliedImpulse,
                        -point.m_appliedImpulseLateral1);
        if (role1.touched)
          role1.touched(p_W, role0, part_of(*manifold->getBody0(), point.m_partId0), point.m_appliedImpulse,
                        point.m_appliedImpulseLateral1);
      }
    }
  }

 private:
  // A body of triangles holds the hall's parts from its user index on; others have -1.
  static int part_of(const btCollisionObject& body, int part) { return part < 0 ? part : std::max(0, body.getUserIndex()) + part; }

  void solveConstraints(btContactSolverInfo& info) override {
    for (int m = 0; m < getDispatcher()->getNumManifolds(); ++m) set_motion(*getDispatcher()->getManifoldByIndexInternal(m));
    btDiscreteDynamicsWorld::solveConstraints(info);
  }

  static void set_motion(btPersistentManifold& manifold) {
    const BodyRole& role0 = BulletWorld::role_of(*manifold.getBody0());
    const BodyRole& role1 = BulletWorld::role_of(*manifold.getBody1());
    const bool first = static_cast<bool>(role0.surface);
    if (!first && !role1.surface) return;
    const BodyRole &role = first ? role0 : role1, &other = first ? role1 : role0;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      btManifoldPoint& point = manifold.getContactPoint(i);
      SurfaceMotion motion;
      if (!role.surface(from_bullet(point.getPositionWorldOnB()), other, motion)) {
        point.m_contactPointFlags &= ~BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
        continue;
      }
      if (motion.level) {
        // Only what presses down counts; the normal points towards body 0.
        const btScalar up = first ? -1.0 : 1.0;
        point.m_normalWorldOnB = btVector3(0, 0, up);
        point.m_distance1 = (point.m_positionWorldOnA.z() - point.m_positionWorldOnB.z()) * up;
      }
      const btVector3 normal = point.m_normalWorldOnB;
      btVector3 along = to_bullet(motion.direction_W);
      along -= normal * normal.dot(along);
      const btScalar length = along.length();
      if (length < 1e-6) {
        point.m_contactPointFlags &= ~BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
        continue;
      }
      along /= length;
      point.m_lateralFrictionDir1 = along;
      point.m_lateralFrictionDir2 = normal.cross(along).normalized();
      // Bullet wants the speed of body 0 relative to body 1.
      point.m_contactMotion1 = first ? -motion.speed : motion.speed;
      point.m_contactMotion2 = 0.0;
      point.m_combinedFriction = motion.friction;
      point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
    }
  }
};

}  // namespace

btTransform to_bullet(const Pose& X) {
  const Eigen::Matrix3d R = X.linear();
  const btMatrix3x3 rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2));
  return btTransform(rotation, to_bullet(Eigen::Vector3d(X.translation())));
}

Eigen::Quaterniond rotation_from_bullet(const btTransform& X) {
  const btQuaternion q = X.getRotation();
  return Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized();
}

Pose from_bullet(const btTransform& X) {
  Pose out = Pose::Identity();
  out.linear() = rotation_from_bullet(X).toRotationMatrix();
  out.translation() = from_bullet(X.getOrigin());
  return out;
}

// Members are destroyed from the last to the first: bodies leave before what they stand on.
struct BulletWorld::World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  std::vector<std::vector<btVector3>> vertices;  // of triangle meshes; kept where they are
  std::vector<std::vector<int>> corners;
  std::vector<std::unique_ptr<btTriangleIndexVertexArray>> meshes;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  SurfaceMovingWorld dynamics{&dispatcher, &broadphase, &solver, &configuration};

  ~World() {
    for (const auto& body : bodies) {
      if (body->isInWorld()) dynamics.removeRigidBody(body.get());
    }
  }

  template <class Shape>
  Shape* keep(std::unique_ptr<Shape> shape) {
    Shape* kept = shape.get();
    shapes.push_back(std::move(shape));
    return kept;
  }
};

BulletWorld::BulletWorld(double step_s) : step_s_(step_s), world_(std::make_unique<World>()) {
  WARETWIN_CHECK(step_s > 0.0, "steps take time");
  btDiscreteDynamicsWorld& dynamics = world_->dynamics;
  dynamics.setGravity({0, 0, -kGravity});
  btContactSolverInfo& info = dynamics.getSolverInfo();
  info.m_numIterations = 30;
  info.m_solverMode |= SOLVER_ENABLE_FRICTION_DIRECTION_CACHING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  // Resting things are not pushed apart by speeds that stay.
  info.m_splitImpulse = 1;
}

BulletWorld::~BulletWorld() = default;

void BulletWorld::step() {
  world_->dynamics.stepSimulation(step_s_, 0);
  world_->dynamics.report_touches();
}

void BulletWorld::add_floor(BodyRole& role, double friction) {
  add_body(role, world_->keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0)), Pose::Identity(), 0.0, friction);
}

void BulletWorld::add_triangles(BodyRole& role, const std::vector<std::vector<Eigen::Vector3d>>& parts, double friction) {
  // Bullet's tree has ten bits for a part's number and reads beyond its arrays where there are more: as many bodies as it takes.
  constexpr std::size_t kMostParts = std::size_t{1} << MAX_NUM_PARTS_IN_BITS;
  for (std::size_t first = 0; first < parts.size(); first += kMostParts) {
    const std::size_t count = std::min(kMostParts, parts.size() - first);
    add_triangles(role, std::span(parts).subspan(first, count), friction, static_cast<int>(first));
  }
}

void BulletWorld::add_triangles(BodyRole& role, std::span<const std::vector<Eigen::Vector3d>> parts, double friction, int first) {
  auto mesh = std::make_unique<btTriangleIndexVertexArray>();
  for (const std::vector<Eigen::Vector3d>& part : parts) {
    std::vector<btVector3>& vertices = world_->vertices.emplace_back();
    std::vector<int>& corners = world_->corners.emplace_back();
    for (const Eigen::Vector3d& p : part) vertices.push_back(to_bullet(p));
    for (std::size_t i = 0; i < part.size(); ++i) corners.push_back(static_cast<int>(i));
    WARETWIN_CHECK(!part.empty(), "Bullet takes no parts without triangles");
    btIndexedMesh indexed;
    indexed.m_numTriangles = static_cast<int>(corners.size() / 3);
    indexed.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(corners.data());
    indexed.m_triangleIndexStride = 3 * sizeof(int);
    indexed.m_numVertices = static_cast<int>(vertices.size());
    indexed.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
    indexed.m_vertexStride = sizeof(btVector3);
    indexed.m_vertexType = PHY_DOUBLE;
    mesh->addIndexedMesh(indexed, PHY_INTEGER);
  }
  btRigidBody* const body =
      add_body(role, world_->keep(std::make_unique<btBvhTriangleMeshShape>(mesh.get(), true)), Pose::Identity(), 0.0, friction);
  body->setUserIndex(first);
  world_->meshes.push_back(std::move(mesh));
}

btCollisionShape* BulletWorld::box(const Eigen::Vector3d& size) {
  auto shape = std::make_unique<btBoxShape>(to_bullet(0.5 * size));
  // A margin of 4 cm, Bullet's default, rounds the corners of parcels.
  shape->setMargin(std::min(0.002, 0.2 * size.minCoeff()));
  return world_->keep(std::move(shape));
}

btCollisionShape* BulletWorld::hull(const std::vector<Eigen::Vector3d>& points) {
  auto shape = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3d& p : points) shape->addPoint(to_bullet(p), false);
  shape->setMargin(0.0);
  shape->recalcLocalAabb();
  return world_->keep(std::move(shape));
}

btCollisionShape* BulletWorld::sphere(double radius) { return world_->keep(std::make_unique<btSphereShape>(radius)); }
btCompoundShape* BulletWorld::compound() { return world_->keep(std::make_unique<btCompoundShape>()); }

btRigidBody* BulletWorld::add_body(BodyRole& role, btCollisionShape* shape, const Pose& X_WS, double mass, double friction) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
  info.m_startWorldTransform = to_bullet(X_WS);
  // Bullet multiplies the two; the root of both keeps a surface's own value against its like.
  info.m_friction = std::sqrt(friction);
  auto body = std::make_unique<btRigidBody>(info);
  body->setUserPointer(&role);
  world_->dynamics.addRigidBody(body.get(), role.group, partners(role.group));
  world_->bodies.push_back(std::move(body));
  return world_->bodies.back().get();
}

void BulletWorld::make_kinematic(btRigidBody& body) {
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
}

// Bullet takes a kinematic body's speed from where it was at the last step and where it is now.
void BulletWorld::move_kinematic(btRigidBody& body, const Pose& X_WS) { body.setWorldTransform(to_bullet(X_WS)); }

void BulletWorld::take_out(btRigidBody& body) {
  if (body.isInWorld()) world_->dynamics.removeRigidBody(&body);
}

void BulletWorld::put_in(btRigidBody& body, const Pose& X_WS) {
  const btTransform X = to_bullet(X_WS);
  body.setWorldTransform(X);
  body.setInterpolationWorldTransform(X);
  body.setLinearVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  body.clearForces();
  if (!body.isInWorld()) {
    const BodyRole::Group group = role_of(body).group;
    world_->dynamics.addRigidBody(&body, group, partners(group));
  }
  body.activate(true);
}

bool BulletWorld::would_touch(btRigidBody& body, const Pose& X_WS, int groups) {
  struct Found final : btCollisionWorld::ContactResultCallback {
    bool any = false;
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int, const btCollisionObjectWrapper*, int,
                             int) override {
      any = true;
      return 0;
    }
  } found;
  found.m_collisionFilterGroup = role_of(body).group;
  found.m_collisionFilterMask = groups;
  body.setWorldTransform(to_bullet(X_WS));
  world_->dynamics.contactTest(&body, found);
  return found.any;
}

}  // namespace waretwin
