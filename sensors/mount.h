// Where a sensor sits on the vehicle.
#pragma once

#include "core/fields.h"
#include "core/pose.h"

namespace waretwin {

// Position in the base frame B (x forward, y left, z up, origin on the floor under the vehicle's centre) and the direction of the sensor's
// forward axis: yaw to the left, then pitch downwards, then roll to the right, R = Rz(yaw) * Ry(pitch) * Rx(roll).
struct Mount {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;

  Pose X_BL() const;  // of a sensor whose x axis points forward (lasers)
  Pose X_BC() const;  // of a camera: z forward, x right, y down
  void visit(Fields& f);
};

}  // namespace waretwin
