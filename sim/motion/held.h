// Things that are held still in one place after the other: pure functions of time, nothing pushes them and they push nobody.
#pragma once

#include "core/pose.h"
#include "scenes/motion_config.h"

namespace waretwin {

// The thing itself: in its first place until `hold_s`, then on its way for `move_s`, and so on; in its last place for ever.
Pose held_X_WG(const HeldConfig& config, double time_s);

// Its stand, upright at the same place.
Pose stand_X_WG(const HeldConfig& config, double time_s);

// How many movers of the scene are these things and their stands; they are its last ones.
std::size_t held_mover_count(const MotionConfig& config);

}  // namespace waretwin
