// The light that a time-of-flight depth camera gets back from a hall.
//
// Every pixel's centre is looked at once. Where surfaces bend or break off within reach of the pixel (its area, and how far the picture
// moves during the exposure), it is looked at nine times: one ray for each pulse, from where the camera is at that pulse, through another
// ninth of the pixel. Each look is a phasor: its length is the light that returns (infrared_answer over range squared), its angle the range
// in half waves of the modulation. The phasors add up, so edges between near surfaces give a range in between (flying pixels) and those
// between far ones cancel. Elsewhere the mean over a pixel of a plane is its centre, and one look is enough.
//
// Multipath: light that comes by way of one other surface arrives later. On a grid of every fourth pixel a few rays look around the
// surface; what they hit is lit by the camera as well, and adds a phasor turned by the longer way (cf. Fuchs, "Multipath interference
// compensation in time-of-flight camera images", ICPR 2010).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/pose.h"
#include "sensors/time_of_flight.h"
#include "sim/ray_caster.h"
#include "sim/surfaces.h"

namespace waretwin {

class TimeOfFlightCamera {
 public:
  using PulsePoses = std::array<Pose, kTimeOfFlightPulses>;  // of the depth camera in the world; the middle one is the frame's

  using PulseTimes = std::array<float, kTimeOfFlightPulses>;  // Ray::time of each pulse

  // `rays`: TimeOfFlightModel::rays. `surfaces` outlives the camera.
  TimeOfFlightCamera(std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces, const CameraConfig& camera,
                     const cv::Mat& rays);
  ~TimeOfFlightCamera();
  TimeOfFlightCamera(TimeOfFlightCamera&&) noexcept;

  // One picture's light. Keeps its buffers: one picture at a time. The result depends on the poses, the times and the hall alone. What
  // moves is seen at the middle pulse, its edges at each pulse.
  TimeOfFlightSignal look(const PulsePoses& X_WD, const PulseTimes& times);
  TimeOfFlightSignal look(const PulsePoses& X_WD);  // all in the middle of the shutter

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin
