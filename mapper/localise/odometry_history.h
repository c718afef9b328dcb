// The last odometry readings, asked for the motion between two instants.
#pragma once

#include <deque>

#include "mapper/localise/point_to_line.h"
#include "sensors/measurements.h"

namespace waretwin {

// X_AB as a motion in the plane of A: z, roll and pitch are left out.
PlanarMotion planar(const Pose& X_AB);
Pose upright(const PlanarMotion& X_AB);

class OdometryHistory {
 public:
  void add(Stamp stamp, const PlanarMotion& X_OB);
  bool empty() const { return readings_.empty(); }
  Stamp newest() const { return readings_.back().stamp; }

  // X_OB at an instant: interpolated between readings; after the newest (before the oldest) one carried on with the velocity of the last
  // (first) 60 ms, for at most half a second. Needs at least one reading.
  PlanarMotion at(Stamp stamp) const;
  // Motion of the base from one instant to the other: X_B(from)B(to). Identity without readings.
  PlanarMotion between(Stamp from, Stamp to) const;

 private:
  struct Reading {
    Stamp stamp;
    PlanarMotion X_OB;
  };
  PlanarMotion carried_on(const Reading& from, const Reading& to, const Reading& base, Stamp stamp) const;

  std::deque<Reading> readings_;  // ascending stamps, the last few seconds
};

}  // namespace waretwin
