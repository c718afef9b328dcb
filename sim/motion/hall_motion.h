// The hall in motion: the vehicle, belts and what they carry, clutter, people; all that stands elsewhere a moment later.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/stamp.h"
#include "scenes/scenario.h"
#include "sim/ray_caster.h"

namespace waretwin {

// Where the movers are during a stretch of time; from one end to the other they move evenly.
struct HallMoment {
  struct Place {
    bool present = false;
    Eigen::Affine3f X_WG_begin = Eigen::Affine3f::Identity(), X_WG_end = Eigen::Affine3f::Identity();
  };
  Stamp begin = 0, end = 0;
  std::vector<Place> movers;  // as many as Scene::movers
  Place vehicle;              // Scene::vehicle, in its frame B

  // Opens the caster's shutter for this stretch and puts the movers there. Costs next to nothing where nothing has changed.
  void show(RayCaster& ray_caster) const;
};

// The vehicle touched something beside the floor: an error of the drive.
struct RobotContact {
  Stamp begin = 0, end = 0;                       // touches less than a second apart count as one
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  // where it began
  std::string with;                               // name of the node, item or walker
  double force_n = 0.0;                           // largest, of all points that touch at the same time
};

struct BeltReport {
  std::string name;
  double wanted_mps = 0.0;  // now
  // Of items that it alone carried at a steady speed: their speed over the surface's; the mean of all, and that of the ride farthest
  // from 1. 1 without items.
  double mean_ratio = 1.0, worst_ratio = 1.0;
  double carried_s = 0.0;  // over how much time of items
};

struct MotionReport {
  int items_in = 0, items_delivered = 0, items_in_hall = 0;  // of streams
  int items_fell_off = 0;                                    // reached the floor
  int items_fell_through = 0;                                // went down through the surface that carried them
  int items_waited = 0;                                      // came in later than due, since their place was taken
  std::vector<BeltReport> belts;
  std::vector<RobotContact> contacts;
};

// Time goes forward only: advance_to before asking for what is later. Physics runs on fixed steps from the same beginning, so the same
// scenario and seed give the same bytes, however the asking is divided and at any number of threads.
class HallMotion {
 public:
  // Reads the running surfaces of belts with rays; the movers of the caster's scene are out of it (not present) afterwards. Throws Error
  // for a route without waypoints and for belts that are none.
  HallMotion(const Scenario& scenario, RayCaster& ray_caster);
  ~HallMotion();
  HallMotion(const HallMotion&) = delete;
  HallMotion& operator=(const HallMotion&) = delete;

  void advance_to(Stamp stamp);

  // The vehicle at any time up to the last advance; before the start and after the end of the route it stands. Drive model `exact`: at any
  // time at all.
  Pose X_WB(Stamp stamp) const;
  // Dead reckoning by the wheels since stamp 0, in the world: what odometry measures. As X_WB with drive model `exact`. At most half a
  // second before the last advance.
  Pose wheels_X_WB(Stamp stamp) const;
  // At most half a second before the last advance and not after it.
  HallMoment moment(Stamp begin, Stamp end) const;

  Stamp duration() const;     // of the route
  double distance_m() const;  // of the route
  MotionReport report() const;
  // Fingerprint of where everything is now.
  std::string digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin
