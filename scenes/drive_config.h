// How the vehicle rolls: a differential drive on two wheels with four sprung casters (sim/motion/drive.h).
#pragma once

#include <string>

#include "core/fields.h"

namespace waretwin {

struct DriveConfig {
  // wheels: a rigid body on wheels that grip, slip and give way under load; wheel odometry counts what the wheels turn. exact: the vehicle
  // follows its route without error and its wheels count its true motion.
  std::string model = "wheels";
  double mass_kg = 60.0;
  double payload_kg = 0.0;  // a load that lies still on the vehicle, its middle at:
  double payload_x_m = 0.0, payload_y_m = 0.0, payload_z_m = 0.6;
  double wheel_radius_m = 0.075;
  double track_m = 0.46;              // between the wheels
  double floor_friction = 0.7;        // Coulomb; beyond it a wheel skids
  double creep_stiffness = 30.0;      // traction / load per unit of slip while it grips: slip = traction / (stiffness * load)
  double tyre_stiffness_n_m = 2.5e5;  // a tyre under more load rolls on a smaller radius
  double caster_share = 0.3;          // of the empty vehicle's weight on the casters
  void visit(Fields& f);
};

}  // namespace waretwin
