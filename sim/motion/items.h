// Loose things: parcels that come in streams and leave by sinks, clutter that was dropped.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "scenes/scenario.h"
#include "sim/motion/bullet_world.h"

namespace waretwin {

struct Item {
  BodyRole role;
  btRigidBody* body = nullptr;
  Pose X_GS = Pose::Identity();  // centre of mass S in the model's frame G
  bool present = false;
  bool clutter = false;
  int stay = 0;                // which stay in the hall this is: what comes in again is another item
  bool fell_through = false;   // in this stay
  bool touched_floor = false;  // since it came in
  int belt = -1;               // index of the belt that last carried it; -1 = none yet
  double alone_s = 0.0;        // how long that belt alone has carried it
  double ride_sum = 0.0;       // of its speed over the surface's in the present ride; see Belt
  long ride_samples = 0;

  void begin_stay() {
    present = true;
    ++stay;
    fell_through = touched_floor = false;
    belt = -1;
    alone_s = ride_sum = 0.0;
    ride_samples = 0;
  }
  Pose X_WG() const { return from_bullet(body->getWorldTransform()) * X_GS.inverse(); }
  Eigen::Vector3d middle() const { return from_bullet(body->getWorldTransform().getOrigin()); }
};

struct ItemCounts {
  int came_in = 0, delivered = 0, in_hall = 0;
  int fell_off = 0;      // of streams' items: reached the floor
  int fell_through = 0;  // left the belt that carried them downwards through its surface
  int waited = 0;        // came in later than due, since their place was taken
};

// Items stand in Scene::movers in this order: streams', then clutter.
class Items {
 public:
  // Bodies are made and kept out of the world. `seed` is the scenario's.
  Items(BulletWorld& world, const Scene& scene, const MotionConfig& config, std::uint64_t seed);

  // Drops all clutter, above whatever moves there already.
  void drop_clutter();
  // Before a step: lets in what is due at `time_s`, where the place is free.
  void let_in(double time_s);
  // After a step: takes out what lies in a sink.
  void take_out();

  std::deque<Item>& all() { return items_; }
  const std::deque<Item>& all() const { return items_; }
  ItemCounts& counts() { return counts_; }

 private:
  struct Stream {
    ItemStream config;
    std::size_t first = 0;  // of its items
    double due_s = 0.0;
    std::uint64_t number = 0;  // of the next item, from 0
    bool waiting = false;
  };
  Pose next_place(const Stream& stream) const;  // X_WG
  void make(const Scene& scene, std::size_t mover, const std::string& name, const ItemBody& body);

  BulletWorld& world_;
  MotionConfig config_;
  std::uint64_t seed_;
  std::deque<Item> items_;  // keeps addresses
  std::vector<Stream> streams_;
  std::size_t first_clutter_ = 0;
  ItemCounts counts_;
};

// Vertices of a mover in its own frame G.
std::vector<Eigen::Vector3d> vertices_G(const Scene& scene, const Mover& mover);

}  // namespace waretwin
