// How much of each object the mapped frames saw: truth.json's visible_fraction.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/pose.h"
#include "scenes/scenario.h"
#include "sensors/sensors_config.h"

namespace waretwin {

class RayCaster;

// The share of an object's viewable surface that the depth of the frames saw. The surface is sampled by area, the same points in every
// run. A point is viewable when from at least one free place a camera at its own height sees it: no farther than the depth range in a
// straight line, at no flatter angle than 5 deg, with nothing in between. A place is free when the robot can stand there: inside the
// hall's bounds, with nothing between 3 cm above the floor and the robot's height within half its diagonal (searched with rays, so a thin
// post may be missed). A point is seen in a frame when it is viewable and projects into the image and the depth field, within the depth
// range, at no flatter angle than 5 deg, with nothing in between.
class SurfaceCoverage {
 public:
  // Cameras by sensor name. Throws Error when there are none.
  SurfaceCoverage(std::shared_ptr<const RayCaster> ray_caster, std::map<std::string, CameraConfig> cameras, const RobotConfig& robot,
                  int points_per_object = 2000, double place_spacing_m = 0.25);
  ~SurfaceCoverage();
  SurfaceCoverage(const SurfaceCoverage&) = delete;
  SurfaceCoverage& operator=(const SurfaceCoverage&) = delete;

  // A frame that was mapped. Throws Error for an unknown sensor.
  void add_frame(const std::string& sensor, const Pose& X_WC);
  // Forgets all frames: for another route through the same hall.
  void forget_frames();

  // Seen points among the viewable ones, in [0, 1]; 0 where nothing of the object is viewable. Throws Error for an unknown id.
  double fraction(int object_id) const;
  // What a frame would add to fraction(): seen by it and by none before. For planning routes.
  double would_add(const std::string& sensor, const Pose& X_WC, int object_id) const;
  // Share of the whole surface that is viewable, in [0, 1].
  double viewable(int object_id) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waretwin
