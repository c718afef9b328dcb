// Where a sensor sits on the vehicle.
#pragma once

#include "core/fields.h"
#include "core/pose.h"

namespace waretwin {

// How far the bracket that was built is off the one that was drawn: normal errors of each axis, drawn once from seed and sensor. Nobody
// tells the mapper.
struct BracketTolerance {
  double position_sigma_m = 0.0;
  double angle_sigma_deg = 0.0;
  void visit(Fields& f);
};

// How the sensor shakes while the vehicle rolls, each axis by itself: noise of this root mean square in a band of half to one and a half
// times the frequency. It grows with the speed, up to full_speed_mps; a standing vehicle does not shake.
struct MountVibration {
  double position_rms_m = 0.0;
  double angle_rms_deg = 0.0;
  double frequency_hz = 12.0;
  double full_speed_mps = 0.5;
  bool any() const { return position_rms_m > 0.0 || angle_rms_deg > 0.0; }
  void visit(Fields& f);
};

// Position in the base frame B (x forward, y left, z up, origin on the floor under the vehicle's centre) and the direction of the sensor's
// forward axis: yaw to the left, then pitch downwards, then roll to the right, R = Rz(yaw) * Ry(pitch) * Rx(roll).
struct Mount {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
  BracketTolerance bracket = {};
  MountVibration vibration = {};

  // As drawn, without bracket and vibration: what the mapper is told.
  Pose X_BL() const;  // of a sensor whose x axis points forward (lasers)
  Pose X_BC() const;  // of a camera: z forward, x right, y down
  void visit(Fields& f);
};

}  // namespace waretwin
