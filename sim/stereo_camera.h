// What the two infrared cameras of a stereo depth camera see of a hall.
//
// Every pixel of the left camera looks at its centre once; a second ray tells whether the right camera sees the point, which lies behind
// something for a strip left of every foreground edge and outside its picture at the left border. Brightness comes from the surfaces'
// answer at 850 nm (infrared.h): the hall's light falls evenly from above, dots of the projector from beside the lens. Both cameras take
// one instant (global shutter); shadows, mirror images and the gap between projector and lens are left out.
#pragma once

#include <memory>

#include "core/pose.h"
#include "sensors/stereo.h"
#include "sim/ray_caster.h"
#include "sim/surfaces.h"

namespace waretwin {

class StereoCamera {
 public:
  // `surfaces` outlives the camera.
  StereoCamera(std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces, const CameraConfig& camera);

  // X_WD: the left camera in the world at that moment of the ray caster's shutter. The result depends on the two and the hall alone.
  StereoSignal look(const Pose& X_WD, Stamp moment) const;

 private:
  std::shared_ptr<const RayCaster> ray_caster_;
  const Surfaces& surfaces_;
  CameraConfig camera_;
  Intrinsics intrinsics_;
};

}  // namespace waretwin
