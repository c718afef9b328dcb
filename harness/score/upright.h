// Where a run's folder holds things in two worlds.
#pragma once

#include <filesystem>

#include "core/pose.h"

namespace waretwin {

// X_UR: the recording's world R (PLY files, trajectories) in the upright one U (cuboids, frames), from upright.json; identity where there
// is none, for then they are the same. Throws Error naming the file where that is no pose.
Pose upright_from_recording(const std::filesystem::path& folder);

}  // namespace waretwin
