// The vehicle's motion along its route, in closed form: a differential drive that turns in place, drives straight, and stands.
#pragma once

#include <vector>

#include "core/pose.h"
#include "core/stamp.h"
#include "scenes/scenario.h"

namespace waretwin {

// Velocity in the vehicle's own frame.
struct Twist {
  double forward_mps = 0.0;  // negative: backwards
  double turn_rad_s = 0.0;   // counter-clockwise from above
};

// From rest to rest over a distance, with a bounded speed and a constant acceleration at both ends (trapezoidal; triangular where the
// distance is too short to reach the speed).
class TrapezoidalProfile {
 public:
  // distance >= 0; speed and acceleration > 0.
  TrapezoidalProfile(double distance, double speed, double acceleration);
  double duration() const { return 2.0 * ramp_s_ + cruise_s_; }
  double position(double t) const;  // 0 before the start, exactly `distance` after the end
  double velocity(double t) const;

 private:
  double distance_, peak_ = 0.0, acceleration_, ramp_s_ = 0.0, cruise_s_ = 0.0;
};

// The route as one waypoint after the other: turn towards it (away from it where it is driven in reverse), drive there, turn to its
// heading, wait. The first waypoint is where the robot stands at stamp 0; without a heading it looks towards the second.
class RobotMotion {
 public:
  // Throws Error for an empty route or a limit that is not positive.
  explicit RobotMotion(const RobotConfig& config);

  // Pose on the floor (z = roll = pitch = 0); stands still before stamp 0 and after the end.
  Pose X_WB(Stamp stamp) const;
  Twist twist(Stamp stamp) const;
  Stamp duration() const;     // rounded up to a whole nanosecond
  double distance_m() const;  // driven, forwards and backwards
  double turned_rad() const;  // sum of all turns, either way
  // When the robot has arrived at waypoint i and turned to its heading (before it waits).
  Stamp arrival(std::size_t waypoint) const { return arrivals_.at(waypoint); }

 private:
  struct Segment {
    double start_s;
    double x, y, yaw;  // at its start
    double drive;      // metres, signed; 0 for turns and waits
    double turn;       // radians, signed
    TrapezoidalProfile profile;
    double duration_s;
  };
  const Segment& segment_at(double t) const;
  void add(double drive, double turn, double wait_s, double speed, double acceleration);

  std::vector<Segment> segments_;
  std::vector<Stamp> arrivals_;
  double x_ = 0.0, y_ = 0.0, yaw_ = 0.0, end_s_ = 0.0;
  double distance_m_ = 0.0, turned_rad_ = 0.0;
};

}  // namespace waretwin
