// What moved in a hall, in words.
#pragma once

#include <string>

#include "sim/motion/hall_motion.h"

namespace waretwin {

// "the vehicle touched 'cabinet' at 12.40 s, at (1.05, -0.20, 0.31), for 0.25 s with up to 840 N".
std::string contact_text(const RobotContact& contact);

// A table of belts, what became of the items, and all contacts.
std::string motion_text(const MotionReport& report);

}  // namespace waretwin
